// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include "base/error.h"

namespace glisson {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw BadInput("cannot write '" + file.filename().string() + "': " + std::strerror(error) +
                 "; check the folder's rights and the free space");
}

std::string randomWord() {
  static constexpr char letters[] = "0123456789abcdefghijklmnopqrstuvwxyz";
  std::random_device source;
  std::string word;
  for (int n = 0; n < 16; ++n) word += letters[source() % 36];
  return word;
}

}  // namespace

PartFile::PartFile(std::filesystem::path file, const std::string& ending) : file_(std::move(file)) {
  for (int tries = 0; tries < 8 && descriptor_ < 0; ++tries) {
    path_ = file_;
    path_ += ".part" + randomWord() + ending;
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor_ < 0 && errno != EEXIST) fail(file_, errno);
  }
  if (descriptor_ < 0) fail(file_, EEXIST);
  there_ = true;
}

PartFile::~PartFile() {
  close();
  if (there_) ::unlink(path_.c_str());
}

void PartFile::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void PartFile::write(const void* bytes, std::size_t count) {
  const auto* from = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = ::write(descriptor_, from + done, count - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file_, errno);
    done += static_cast<std::size_t>(n);
  }
}

void PartFile::become() {
  close();
  // A library may have replaced the file rather than filled it: what lies there now is meant.
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0 || ::fsync(descriptor_) != 0) fail(file_, errno);
  close();
  if (::rename(path_.c_str(), file_.c_str()) != 0) fail(file_, errno);
  there_ = false;
  const std::filesystem::path folder = file_.parent_path().empty() ? "." : file_.parent_path();
  if (const int where = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); where >= 0) {
    ::fsync(where);  // some file systems cannot; the rename itself is done
    ::close(where);
  }
}

}  // namespace glisson
