// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/reader_process.h"

#include <unistd.h>

#include <mutex>
#include <optional>
#include <utility>

#include "base/error.h"
#include "dicom/detail/header_wire.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/reader_child.h"
#include "dicom/detail/reader_protocol.h"
#include "dicom/detail/wire.h"
#include "dicom/series.h"

namespace glisson::dicom {
namespace {

using detail::Answer;
using detail::Ask;
using detail::ReaderChild;
using detail::ReaderFailure;
using detail::ReaderPool;
using detail::WireReader;
using detail::WireWriter;
namespace fs = std::filesystem;

struct Location {
  std::mutex mutex;
  fs::path program;
};

Location& location() {
  static Location there;
  return there;
}

/// What a reader process says of a file that it refuses, checked.
RefusedFile refusalIn(const std::string& answer) {
  RefusedFile refused;
  try {
    WireReader w(answer);
    w(refused.reason);
    w(refused.seriesUid);
    w(refused.outOfMemory);
    w.end();
    if (refused.seriesUid.size() > 64 || refused.seriesUid.find_first_not_of("0123456789.") != std::string::npos)
      WireReader::fail();
    return refused;
  } catch (const BadInput& e) {
    refused = {};
    refused.reason = e.what();
    return refused;
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

IsolatedFile::IsolatedFile(const fs::path& file) : file_(file) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) refuse("is no regular file");
  fileBytes_ = fs::file_size(file, failed);
  if (failed) refuse("cannot be opened (is it readable?)");
}

IsolatedFile::~IsolatedFile() {
  if (process_) ReaderPool::get().giveBack(std::move(process_));
}

void IsolatedFile::start() {
  const fs::path program = readerProgram();
  if (program.empty())
    refuse(
        "is compressed, deeply nested or oddly encoded, so that only the program glisson-reader may open it, and that "
        "is not installed beside this program");
  process_ = ReaderPool::get().take(program);
  if (!process_) process_ = std::make_unique<ReaderChild>(program);
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
    std::optional<ReaderFailure> failure;
    if (process_->send(static_cast<Ask>(request), payload))
      failure = process_->receive(wait_s, std::max<std::uint64_t>(largestAnswer, 128 * 1024), kind, answer);
    else
      failure = ReaderFailure{"ended the process that was decoding it; it is left out"};
    if (!failure) {
      if (kind != Answer::Refused) return answer;
      const RefusedFile refused = refusalIn(answer);
      // Memory that other files left in use is not this one's fault.
      if (!(used && attempt == 0 && refused.outOfMemory && static_cast<Ask>(request) != Ask::Frame))
        refuse(detail::shownFrom(refused.reason), refused.seriesUid);
    }
    process_.reset();
    if (attempt > 0 || !used || static_cast<Ask>(request) == Ask::Frame || (failure && failure->tookTooLong))
      refuse(failure ? failure->why : "cannot be read");
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
  const std::unique_ptr<ReaderChild> process = std::move(process_);
  if (!process->send(Ask::Unpack, openPayload(file_, limits))) refuse("ended the process that was decoding it");
  bool wanted = false;
  for (;;) {
    Answer kind{};
    std::string answer;
    if (const auto failure = process->receive(5.0 + 4.0 * limits.cpu_s, 2 * detail::dataPiece, kind, answer))
      refuse(failure->why);
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
