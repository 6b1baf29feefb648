#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace glisson {

namespace {

constexpr std::uintmax_t largest_bytes = 256u << 20;

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw BadInput("cannot write '" + file.filename().string() + "': " + std::strerror(error) +
                 "; check the folder's rights and the free space");
}

/// Closes what it opened.
struct Descriptor {
  int fd = -1;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

void writeAtomically(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path beside = file;
  beside += ".part" + std::to_string(::getpid());  // two programs never share it
  try {
    Descriptor out{::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (out.fd < 0) fail(file, errno);
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = ::write(out.fd, text.data() + done, text.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail(file, errno);
      done += static_cast<std::size_t>(n);
    }
    if (::fsync(out.fd) != 0) fail(file, errno);
  } catch (...) {
    ::unlink(beside.c_str());
    throw;
  }
  if (::rename(beside.c_str(), file.c_str()) != 0) {
    const int error = errno;
    ::unlink(beside.c_str());
    fail(file, error);
  }
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  const Descriptor there{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (there.fd >= 0) ::fsync(there.fd);  // some file systems cannot; the rename itself is done
}

std::string readWhole(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > largest_bytes)
    throw BadInput("'" + file.filename().string() + "' is larger than 256 MB; it is not read as text");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || error) throw BadInput("cannot read '" + file.filename().string() + "'; check that it is there");
  return text.str();
}

}  // namespace glisson
