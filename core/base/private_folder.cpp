// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/private_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>

#include "base/error.h"

namespace glisson {
namespace {

constexpr const char *prefix = "glisson-", *lockEnding = ".lock";

/// An open lock file, locked; -1 where another program holds it or it cannot be opened.
int locked(const std::filesystem::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | flags, 0600);
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

bool mine(const std::filesystem::path& path, mode_t kind) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && (status.st_mode & S_IFMT) == kind && status.st_uid == ::geteuid();
}

/// Folders of programs that were killed: nobody holds their lock any more. Younger ones may just be in the making.
void removeLeftovers(const std::filesystem::path& base) {
  using namespace std::chrono_literals;
  std::error_code failed;
  for (auto entry = std::filesystem::directory_iterator(base, failed); !failed && entry != end(entry);
       entry.increment(failed)) {
    const std::filesystem::path lock = entry->path();
    const std::string name = lock.filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(lockEnding) || !mine(lock, S_IFREG)) continue;
    std::error_code ignored;
    const auto written = std::filesystem::last_write_time(lock, ignored);
    if (ignored || std::filesystem::file_time_type::clock::now() - written < 60s) continue;
    const int descriptor = locked(lock, 0);
    if (descriptor < 0) continue;
    const std::filesystem::path folder = base / lock.stem();
    if (mine(folder, S_IFDIR)) std::filesystem::remove_all(folder, ignored);
    ::unlink(lock.c_str());
    ::close(descriptor);
  }
}

}  // namespace

PrivateFolder::PrivateFolder() {
  std::error_code failed;
  const std::filesystem::path base = std::filesystem::temp_directory_path(failed);
  if (!failed) removeLeftovers(base);
  // mkdtemp replaces the last six characters.
  std::string pattern = (base / (prefix + std::string(6, 'X'))).string();
  if (failed || !mkdtemp(pattern.data()))
    throw BadInput("there is no temporary folder that may be written to; is the disk full? TMPDIR names another one");
  path_ = pattern;
  lock_ = locked(pattern + lockEnding, O_CREAT | O_EXCL);
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  if (lock_ < 0) return;
  ::unlink((path_.string() + lockEnding).c_str());
  ::close(lock_);
}

}  // namespace glisson
