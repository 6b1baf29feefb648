// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/reader_child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "dicom/detail/image_header.h"

namespace glisson::dicom::detail {
namespace {

/// A reader process is given up after this many files, so that what a library leaks does not add up.
constexpr int filesPerProcess = 500;

[[noreturn]] void refuseStart(const std::string& why) {
  RefusedFile refused;
  refused.reason = "needs a reader process, which cannot be started (" + why + ")";
  throw refused;
}

}  // namespace

ReaderChild::ReaderChild(const std::filesystem::path& program) : program_(program) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuseStart("no socket");
  socket_ = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], readerSocket);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, readerSocket + 1);
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
    refuseStart(std::strerror(failed));
  }
}

ReaderChild::~ReaderChild() {
  close(socket_);
  if (pid_ > 0) end(true);
}

bool ReaderChild::send(Ask kind, const std::string& payload) {
  return sendMessage(socket_, static_cast<std::uint32_t>(kind), payload.data(), payload.size());
}

std::optional<ReaderFailure> ReaderChild::receive(double wait_s, std::uint64_t largest, Answer& kind,
                                                  std::string& payload) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * wait_s));
  MessageHead head;
  if (auto why = take(&head, sizeof(head), deadline, wait_s)) return why;
  if (head.kind < 1 || head.kind > static_cast<std::uint32_t>(Answer::Done) || head.length > largest) {
    end(true);
    return ReaderFailure{"was answered by the reader process with a message that makes no sense; the file is left out"};
  }
  kind = static_cast<Answer>(head.kind);
  payload.resize(static_cast<std::size_t>(head.length));
  return take(payload.data(), payload.size(), deadline, wait_s);
}

std::optional<ReaderFailure> ReaderChild::take(void* to, std::size_t count,
                                               std::chrono::steady_clock::time_point deadline, double wait_s) {
  auto* at = static_cast<char*>(to);
  while (count > 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd ready{socket_, POLLIN, 0};
    const int got = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      end(true);
      return ReaderFailure{"gave no answer within " + std::to_string(static_cast<int>(wait_s)) + " s; it is left out"};
    }
    const ssize_t piece = recv(socket_, at, count, 0);
    if (piece < 0 && errno == EINTR) continue;
    if (piece <= 0) return end(false);
    at += piece;
    count -= static_cast<std::size_t>(piece);
  }
  return {};
}

ReaderFailure ReaderChild::end(bool force) {
  if (pid_ <= 0) return {"ended its reader process"};
  if (force) kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (!WIFSIGNALED(status)) return {"ended the process that was decoding it; it is left out"};
  const int signal = WTERMSIG(status);
  if (signal == SIGPROF || signal == SIGXCPU)
    return {"takes longer to decode than its size allows (1.5 s, and 1 s for every 32 MiB of pixels); it is left out",
            true};
  return {std::string("makes the decoder crash (signal SIG") + (sigabbrev_np(signal) ? sigabbrev_np(signal) : "?") +
          "); it is left out"};
}

ReaderPool& ReaderPool::get() {
  static ReaderPool pool;
  return pool;
}

std::unique_ptr<ReaderChild> ReaderPool::take(const std::filesystem::path& program) {
  const std::lock_guard lock(mutex_);
  while (!idle_.empty()) {
    std::unique_ptr<ReaderChild> child = std::move(idle_.back());
    idle_.pop_back();
    if (child->program() == program && child->files < filesPerProcess) return child;
  }
  return {};
}

void ReaderPool::giveBack(std::unique_ptr<ReaderChild> child) {
  const std::lock_guard lock(mutex_);
  if (idle_.size() < 8) idle_.push_back(std::move(child));
}

}  // namespace glisson::dicom::detail
