#include "dicom/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "dicom/detail/header_wire.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/reader_protocol.h"
#include "dicom/detail/wire.h"
#include "dicom/series.h"

namespace glisson::dicom {
namespace {

using detail::Answer;
using detail::Ask;
using detail::WireReader;
using detail::WireWriter;
namespace fs = std::filesystem;

/// A reader process is given up after this many files, so that what a library leaks does not add up.
constexpr int filesPerProcess = 500;

struct Location {
  std::mutex mutex;
  fs::path program;
};

Location& location() {
  static Location there;
  return there;
}

/// Reason and series UID of a refusal.
std::pair<std::string, std::string> refusalIn(const std::string& answer) {
  try {
    WireReader w(answer);
    std::string reason, seriesUid;
    w(reason);
    w(seriesUid);
    w.end();
    if (seriesUid.size() > 64 || seriesUid.find_first_not_of("0123456789.") != std::string::npos) WireReader::fail();
    return {reason, seriesUid};
  } catch (const BadInput& e) {
    return {e.what(), {}};
  }
}

[[noreturn]] void refuse(const std::string& reason, const std::string& seriesUid = {}) {
  RefusedFile refused;
  refused.reason = reason;
  refused.seriesUid = seriesUid;
  throw refused;
}

fs::path besideThisProgram() {
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path();
  if (failed) return {};
  // Installed beside the programs, in a folder for helpers, or in the tree of a build.
  for (const fs::path& place :
       {here / "glisson-reader", here / "../libexec/glisson/glisson-reader", here / "../glisson-reader/glisson-reader"})
    if (access(place.c_str(), X_OK) == 0) return place.lexically_normal();
  return {};
}

}  // namespace

void setReaderProgram(const fs::path& program) {
  const std::lock_guard lock(location().mutex);
  location().program = program;
}

fs::path readerProgram() {
  {
    const std::lock_guard lock(location().mutex);
    if (!location().program.empty()) return location().program;
  }
  static const fs::path found = besideThisProgram();
  return found;
}

ReaderLimits limitsFor(std::uint64_t fileBytes, std::uint64_t decodedBytes) {
  return {memoryBudget(fileBytes), 1.5 + static_cast<double>(decodedBytes) / (32.0 * 1024.0 * 1024.0)};
}

/// A running glisson-reader and the socket to it.
class IsolatedFile::Process {
 public:
  explicit Process(const fs::path& program) : program_(program) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      refuse("needs a reader process, which cannot be started (no socket)");
    socket_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], detail::readerSocket);
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_addclosefrom_np(&actions, detail::readerSocket + 1);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, usual;
    sigemptyset(&none);
    sigfillset(&usual);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    std::string name = program.string();
    char* arguments[] = {name.data(), nullptr};
    const int failed = posix_spawn(&pid_, name.c_str(), &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (failed != 0) {
      close(socket_);
      refuse(std::string("needs a reader process, which cannot be started (") + std::strerror(failed) + ")");
    }
  }

  ~Process() {
    close(socket_);
    if (pid_ > 0) end(true);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  const fs::path& program() const { return program_; }
  int files = 0;

  bool send(Ask kind, const std::string& payload) {
    return detail::sendMessage(socket_, static_cast<std::uint32_t>(kind), payload.data(), payload.size());
  }

  /// Next message, or the reason why there is none. The process is dead after such a reason.
  std::optional<std::string> receive(double wait_s, std::uint64_t largest, Answer& kind, std::string& payload) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * wait_s));
    detail::MessageHead head;
    if (auto why = take(&head, sizeof(head), deadline, wait_s)) return why;
    if (head.kind < 1 || head.kind > static_cast<std::uint32_t>(Answer::Done) || head.length > largest) {
      end(true);
      return "was answered by the reader process with a message that makes no sense; the file is left out";
    }
    kind = static_cast<Answer>(head.kind);
    payload.resize(static_cast<std::size_t>(head.length));
    return take(payload.data(), payload.size(), deadline, wait_s);
  }

 private:
  std::optional<std::string> take(void* to, std::size_t count, std::chrono::steady_clock::time_point deadline,
                                  double wait_s) {
    auto* at = static_cast<char*>(to);
    while (count > 0) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      pollfd ready{socket_, POLLIN, 0};
      const int got = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        end(true);
        return "gave no answer within " + std::to_string(static_cast<int>(wait_s)) + " s; it is left out";
      }
      const ssize_t piece = recv(socket_, at, count, 0);
      if (piece < 0 && errno == EINTR) continue;
      if (piece <= 0) return end(false);
      at += piece;
      count -= static_cast<std::size_t>(piece);
    }
    return {};
  }

  /// Waits for the process to be gone and says of what it died.
  std::string end(bool force) {
    if (pid_ <= 0) return "ended its reader process";
    if (force) kill(pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    if (!WIFSIGNALED(status)) return "ended the process that was decoding it; it is left out";
    const int signal = WTERMSIG(status);
    if (signal == SIGPROF || signal == SIGXCPU)
      return "takes longer to decode than its size allows (1.5 s, and 1 s for every 32 MiB of pixels); it is left out";
    return std::string("makes the decoder crash (signal SIG") + (sigabbrev_np(signal) ? sigabbrev_np(signal) : "?") +
           "); it is left out";
  }

  fs::path program_;
  int socket_ = -1;
  pid_t pid_ = -1;
};

/// Reader processes that are running and have no work; ended with the program.
class IsolatedFile::Pool {
 public:
  static Pool& get() {
    static Pool pool;
    return pool;
  }
  std::unique_ptr<Process> take(const fs::path& program) {
    const std::lock_guard lock(mutex_);
    while (!idle_.empty()) {
      std::unique_ptr<Process> p = std::move(idle_.back());
      idle_.pop_back();
      if (p->program() == program && p->files < filesPerProcess) return p;
    }
    return {};
  }
  void giveBack(std::unique_ptr<Process> process) {
    const std::lock_guard lock(mutex_);
    if (idle_.size() < 8) idle_.push_back(std::move(process));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Process>> idle_;
};

IsolatedFile::IsolatedFile(const fs::path& file) : file_(file) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) refuse("is no regular file");
  fileBytes_ = fs::file_size(file, failed);
  if (failed) refuse("cannot be opened (is it readable?)");
}

IsolatedFile::~IsolatedFile() {
  if (process_) Pool::get().giveBack(std::move(process_));
}

void IsolatedFile::start() {
  const fs::path program = readerProgram();
  if (program.empty())
    refuse(
        "is compressed, deeply nested or oddly encoded, so that only the program glisson-reader may open it, and that "
        "is not installed beside this program");
  process_ = Pool::get().take(program);
  if (!process_) process_ = std::make_unique<Process>(program);
}

std::string IsolatedFile::ask(std::uint32_t request, const std::string& payload, std::uint64_t decodedBytes,
                              std::uint64_t largestAnswer) {
  const double wait_s = 5.0 + 4.0 * limitsFor(fileBytes_, decodedBytes).cpu_s;
  for (int attempt = 0;; ++attempt) {
    if (!process_) start();
    const bool used = process_->files > 0;
    ++process_->files;
    Answer kind{};
    std::string answer;
    std::optional<std::string> why;
    if (process_->send(static_cast<Ask>(request), payload))
      why = process_->receive(wait_s, std::max<std::uint64_t>(largestAnswer, 128 * 1024), kind, answer);
    else
      why = "ended the process that was decoding it; it is left out";
    if (!why) {
      if (kind != Answer::Refused) return answer;
      const auto [reason, seriesUid] = refusalIn(answer);
      // Memory that other files left in use is not this one's fault.
      if (!(used && attempt == 0 && reason.starts_with("asks for more memory") &&
            static_cast<Ask>(request) != Ask::Frame))
        refuse(detail::shownFrom(reason), seriesUid);
    }
    process_.reset();
    if (attempt > 0 || !used || static_cast<Ask>(request) == Ask::Frame || (why && why->starts_with("takes longer")))
      refuse(why.value_or("cannot be read"));
  }
}

namespace {

std::string openPayload(const fs::path& file, const ReaderLimits& limits) {
  std::error_code failed;
  WireWriter w;
  w(fs::absolute(file, failed).string());
  w(static_cast<std::uint32_t>(std::min<std::uint64_t>((limits.memory_bytes >> 20) + 1, 1U << 24)));
  w(limits.cpu_s);
  return std::move(w.bytes);
}

}  // namespace

ImageHeader IsolatedFile::header() {
  const std::string answer = ask(static_cast<std::uint32_t>(Ask::Open), openPayload(file_, limitsFor(fileBytes_, 0)), 0,
                                 memoryBudget(fileBytes_));
  try {
    ImageHeader h = detail::headerFrom(answer, fileBytes_);
    h.file = file_;
    h.isolated = true;
    opened_ = true;
    return h;
  } catch (const BadInput& e) {
    refuse(e.what());
  }
}

std::vector<std::uint8_t> IsolatedFile::frame(int number, std::uint64_t frameBytes) {
  if (!opened_) throw BadArgument("IsolatedFile: a frame was asked for before the header");
  WireWriter w;
  w(number);
  w(limitsFor(fileBytes_, frameBytes).cpu_s);
  const std::string answer = ask(static_cast<std::uint32_t>(Ask::Frame), w.bytes, frameBytes, frameBytes);
  if (answer.size() != frameBytes) refuse("was decoded to another number of bytes than its header says");
  return {answer.begin(), answer.end()};
}

StructureSet IsolatedFile::structures() {
  const std::string answer =
      ask(static_cast<std::uint32_t>(Ask::Structures), openPayload(file_, limitsFor(fileBytes_, 8 * fileBytes_)),
          8 * fileBytes_, memoryBudget(fileBytes_));
  try {
    return detail::structuresFrom(answer);
  } catch (const BadInput& e) {
    refuse(e.what());
  }
}

detail::SegHeader IsolatedFile::segmentation() {
  const std::string answer =
      ask(static_cast<std::uint32_t>(Ask::Segmentation), openPayload(file_, limitsFor(fileBytes_, 8 * fileBytes_)),
          8 * fileBytes_, memoryBudget(fileBytes_));
  try {
    detail::SegHeader h = detail::segHeaderFrom(answer);
    opened_ = true;
    return h;
  } catch (const BadInput& e) {
    refuse(e.what());
  }
}

std::vector<std::vector<std::string>> IsolatedFile::directory() {
  const std::string answer =
      ask(static_cast<std::uint32_t>(Ask::Directory), openPayload(file_, limitsFor(fileBytes_, fileBytes_)), fileBytes_,
          memoryBudget(fileBytes_));
  try {
    WireReader w(answer);
    std::vector<std::vector<std::string>> list;
    w(list);
    w.end();
    return list;
  } catch (const BadInput& e) {
    refuse(e.what());
  }
}

void IsolatedFile::unpack(const EntrySink& sink) {
  const ReaderLimits limits = limitsFor(fileBytes_, 8 * fileBytes_);
  start();
  // Whatever ends this early, the process with its half-told archive is not used again.
  const std::unique_ptr<Process> process = std::move(process_);
  if (!process->send(Ask::Unpack, openPayload(file_, limits))) refuse("ended the process that was decoding it");
  bool wanted = false;
  for (;;) {
    Answer kind{};
    std::string answer;
    if (const auto why = process->receive(5.0 + 4.0 * limits.cpu_s, 2 * detail::dataPiece, kind, answer)) refuse(*why);
    if (kind == Answer::Done) return;
    if (kind == Answer::Data) {
      if (wanted) sink.data(answer.data(), answer.size());
      continue;
    }
    std::string name, reason;
    WireReader w(answer);
    if (kind == Answer::Entry || kind == Answer::EntryRefused) w(name);
    if (kind == Answer::EntryRefused || kind == Answer::Refused) w(reason);
    if (kind == Answer::Refused) refuse(detail::shownFrom(reason));
    if (kind != Answer::Entry && kind != Answer::EntryRefused) WireReader::fail();
    wanted = kind == Answer::Entry && sink.begin(name);
    if (kind == Answer::EntryRefused) sink.refused(name, detail::shownFrom(reason));
  }
}

std::optional<FileLayout> plainLayout(ByteSource& source) {
  if (isDeflated(source)) return {};
  FileLayout layout = readLayout(source);
  if (!layout.plain) return {};
  return layout;
}

std::optional<ImageHeader> readPlainHeader(const fs::path& file) {
  try {
    ByteSource source(file);
    if (const auto layout = plainLayout(source)) return readImageHeader(file, source, *layout);
  } catch (const BadInput& e) {
    refuse(e.what());
  } catch (const std::bad_alloc&) {
    refuse("asks for more memory than there is");
  }
  return std::nullopt;
}

ImageHeader readHeaderSafely(const fs::path& file, std::unique_ptr<IsolatedFile>* keep) {
  if (auto plain = readPlainHeader(file)) return *std::move(plain);
  auto isolated = std::make_unique<IsolatedFile>(file);
  ImageHeader h = isolated->header();
  if (keep != nullptr) *keep = std::move(isolated);
  return h;
}

}  // namespace glisson::dicom
