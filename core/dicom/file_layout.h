// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glisson::dicom {

/// Bytes of a DICOM file: read in place from a regular file, or held in memory after inflating a deflated data set.
class ByteSource {
 public:
  /// Opens without blocking and refuses anything but a regular file. Throws BadInput.
  explicit ByteSource(const std::filesystem::path& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  std::uint64_t size() const { return size_; }
  /// Copies count bytes from offset. Throws BadInput where the source ends before.
  void read(std::uint64_t offset, void* to, std::size_t count) const;
  std::vector<std::uint8_t> bytes(std::uint64_t offset, std::uint64_t count) const;

  /// Replaces the bytes from offset to the end by what they inflate to (raw deflate). Throws BadInput where the stream
  /// is damaged or grows beyond 100 times its size, or beyond the memory budget of a file.
  void inflateFrom(std::uint64_t offset);

 private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::vector<std::uint8_t> memory_;
  mutable std::vector<std::uint8_t> window_;
  mutable std::uint64_t windowBegin_ = 0;
};

/// A piece of encapsulated pixel data: bytes of the file.
struct Fragment {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

/// The element that holds the pixels, at the top level of the data set.
struct PixelElement {
  std::uint16_t element = 0x0010;  ///< of group 7FE0: 0008 float, 0009 double, 0010 integers
  std::uint64_t offset = 0;        ///< of the value
  std::uint64_t length = 0;        ///< native only
  bool encapsulated = false;
  bool words =
      true;  ///< explicit VR OW, or implicit: 16-bit words, which a big-endian file turns round even for 8-bit pixels
  std::vector<Fragment> fragments;  ///< encapsulated only, without the offset table
};

/// How the bytes of a DICOM file are laid out, found without a DICOM library so that nothing hostile reaches one:
/// nesting, lengths, the number of elements and the transfer syntax have been checked.
struct FileLayout {
  std::string transferSyntax;
  std::string sopClassUid;  ///< of the file meta information; may be empty
  bool explicitVr = true;
  bool bigEndian = false;
  std::uint64_t datasetOffset = 0;
  std::uint64_t headerEnd = 0;  ///< where the pixel element begins, or the end of the data set
  std::optional<PixelElement> pixels;
  std::vector<std::string> warnings;
  /// Nothing but what scanners write every day: see readLayout.
  bool plain = false;
};

/// Whether the file meta information says that the data set is deflated. Never inflates. Throws BadInput where the meta
/// information is damaged.
bool isDeflated(const ByteSource& source);

/// Largest number of bytes that one file may grow to in memory: 256 MiB and three times its size.
std::uint64_t memoryBudget(std::uint64_t fileBytes);

/// Walks the file. Inflates source where the data set is deflated. Throws BadInput with a reason (and an offset) that
/// does not name the file: empty, not DICOM, unknown or lying transfer syntax, element beyond the end of the file,
/// truncated pixel data, more than 64 nested sequences, an image-size attribute with another value representation than
/// US, an element that occurs twice with different values.
/// Sets plain where the data set is neither deflated nor compressed, at most 6 sequences deep, of at most 100,000
/// elements and 32 MiB before the pixels, and where nothing is odd about it (no warning but a missing preamble).
FileLayout readLayout(ByteSource& source);

}  // namespace glisson::dicom
