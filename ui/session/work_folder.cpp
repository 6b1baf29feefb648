// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/work_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.h"

namespace glisson::session {

namespace {

constexpr std::string_view prefix = "current-case-", suffix = ".lock";

/// Whether the name still leads to the file that is open: else somebody cleared it away before it was locked.
bool isStill(int fd, const std::filesystem::path& file) {
  struct stat open = {}, named = {};
  return ::fstat(fd, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

// The lock lies beside the folder and is taken before the folder is made: a folder without one is nobody's.
WorkFolder::WorkFolder(const std::filesystem::path& below) {
  std::error_code ignored;
  std::filesystem::create_directories(below, ignored);
  for (int n = 0; fd_ < 0; ++n) {
    path_ = below / (std::string(prefix) + std::to_string(::getpid()) + "-" + std::to_string(n));
    lock_ = path_.string() + std::string(suffix);
    const int fd = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0)
      throw BadInput(std::string("no folder to work in can be made: ") + std::strerror(errno) +
                     "; make room in the cache, or make it writable");
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && isStill(fd, lock_))
      fd_ = fd;
    else
      ::close(fd);
  }
  std::filesystem::remove_all(path_, ignored);  // of a program that had the same number
  std::filesystem::create_directories(path_, ignored);
  std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  ::unlink(lock_.c_str());
  ::close(fd_);
}

int WorkFolder::removeAbandoned(const std::filesystem::path& below) {
  int removed = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(below, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const int fd = ::open(entry.path().c_str(), O_RDWR | O_CLOEXEC);
    if (fd < 0) continue;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && isStill(fd, entry.path())) {
      std::error_code failed;
      std::filesystem::remove_all(below / name.substr(0, name.size() - suffix.size()), failed);
      if (!failed) ::unlink(entry.path().c_str()), ++removed;
    }
    ::close(fd);
  }
  return removed;
}

}  // namespace glisson::session
