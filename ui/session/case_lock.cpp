// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/case_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <ctime>

#include "base/error.h"

namespace glisson::session {

namespace {

std::string thisMachine() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

CaseLock::CaseLock(const std::filesystem::path& folder) : file_(folder / "case.lock") {
  const int fd = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) return;  // read only
  std::array<char, 512> text{};
  const ssize_t n = ::pread(fd, text.data(), text.size() - 1, 0);
  const std::string owner(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  const std::string machine = thisMachine();
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    ::close(fd);
    throw BadInput("this case is open in another window; close it there first");
  }
  const bool elsewhere = !owner.empty() && owner.rfind(machine + "\n", 0) != 0;
  struct stat s {};
  if (elsewhere && ::fstat(fd, &s) == 0 && std::time(nullptr) - s.st_mtime < staleAfter_s) {
    const auto age = static_cast<long>(std::time(nullptr) - s.st_mtime);
    ::close(fd);
    throw BadInput("this case is open on another machine, which touched it " + std::to_string(age) +
                   " s ago; close it there, or wait two minutes where that machine is gone");
  }
  stale_ = !owner.empty();
  const std::string mine = machine + "\n" + std::to_string(::getpid()) + "\n";
  if (::ftruncate(fd, 0) != 0 || ::pwrite(fd, mine.data(), mine.size(), 0) != static_cast<ssize_t>(mine.size())) {
    ::close(fd);
    throw BadInput("the case cannot be locked: the disk is full or broken");
  }
  fd_ = fd;
}

CaseLock::~CaseLock() {
  if (fd_ < 0) return;
  ::unlink(file_.c_str());
  ::close(fd_);
}

void CaseLock::touch() const {
  if (fd_ >= 0) ::futimens(fd_, nullptr);
}

}  // namespace glisson::session
