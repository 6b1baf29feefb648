// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "dicom/file_layout.h"

namespace glisson::dicom {
namespace {
constexpr std::size_t windowSize = 64 * 1024;
constexpr std::uint64_t maxDeflateRatio = 100;
}  // namespace

std::uint64_t memoryBudget(std::uint64_t fileBytes) {
  return 256ULL * 1024 * 1024 + 3 * fileBytes;
}

ByteSource::ByteSource(const std::filesystem::path& file) {
  descriptor_ = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor_ < 0) throw BadInput("cannot be opened (is it readable?)");
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(descriptor_);
    throw BadInput("is no regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

ByteSource::~ByteSource() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ByteSource::read(std::uint64_t offset, void* to, std::size_t count) const {
  if (count > size_ || offset > size_ - count)
    throw BadInput("ends at byte " + std::to_string(size_) + " where " + std::to_string(count) +
                   " bytes were expected at offset " + std::to_string(offset) + " (truncated)");
  if (descriptor_ < 0) {
    std::memcpy(to, memory_.data() + offset, count);
    return;
  }
  const auto readAll = [this](std::uint64_t from, std::uint8_t* into, std::size_t wanted) {
    std::size_t done = 0;
    while (done < wanted) {
      const ssize_t got = pread(descriptor_, into + done, wanted - done, static_cast<off_t>(from + done));
      if (got <= 0) throw BadInput("cannot be read at offset " + std::to_string(from + done));
      done += static_cast<std::size_t>(got);
    }
  };
  if (count > windowSize) return readAll(offset, static_cast<std::uint8_t*>(to), count);
  if (offset < windowBegin_ || offset + count > windowBegin_ + window_.size()) {
    window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(windowSize, size_ - offset)));
    windowBegin_ = offset;
    readAll(offset, window_.data(), window_.size());
  }
  std::memcpy(to, window_.data() + (offset - windowBegin_), count);
}

std::vector<std::uint8_t> ByteSource::bytes(std::uint64_t offset, std::uint64_t count) const {
  if (count > size_ || offset > size_ - count)
    throw BadInput("ends at byte " + std::to_string(size_) + ", before the " + std::to_string(count) +
                   " bytes announced at offset " + std::to_string(offset) + " (truncated)");
  std::vector<std::uint8_t> out(static_cast<std::size_t>(count));
  if (count > 0) read(offset, out.data(), out.size());
  return out;
}

void ByteSource::inflateFrom(std::uint64_t offset) {
  const std::uint64_t packed = size_ - std::min(offset, size_);
  const std::uint64_t limit = std::min(memoryBudget(size_), maxDeflateRatio * packed);
  std::vector<std::uint8_t> in = bytes(offset, packed);
  std::vector<std::uint8_t> out = bytes(0, offset);
  std::vector<std::uint8_t> piece(256 * 1024);
  z_stream z{};
  if (inflateInit2(&z, -MAX_WBITS) != Z_OK) throw BadInput("is deflated, and zlib cannot be started");
  std::size_t fed = 0;
  int state = Z_OK;
  const char* problem = nullptr;
  while (state != Z_STREAM_END && problem == nullptr) {
    if (z.avail_in == 0 && fed < in.size()) {
      const std::size_t next = std::min<std::size_t>(in.size() - fed, 1U << 20);
      z.next_in = in.data() + fed;
      z.avail_in = static_cast<uInt>(next);
      fed += next;
    }
    z.next_out = piece.data();
    z.avail_out = static_cast<uInt>(piece.size());
    state = inflate(&z, Z_NO_FLUSH);
    const std::size_t made = piece.size() - z.avail_out;
    if (state != Z_OK && state != Z_STREAM_END) {
      problem = "is deflated, and the deflated stream is damaged or truncated";
    } else if (out.size() - offset + made > limit) {
      problem = "is deflated and grows beyond 100 times its size or the memory budget; it is refused";
    } else {
      out.insert(out.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(made));
    }
  }
  inflateEnd(&z);
  if (problem != nullptr) throw BadInput(problem);
  close(descriptor_);
  descriptor_ = -1;
  memory_ = std::move(out);
  size_ = memory_.size();
}

}  // namespace glisson::dicom
