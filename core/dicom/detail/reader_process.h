// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dicom/detail/image_header.h"
#include "dicom/rtstruct.h"

namespace glisson::dicom {

namespace detail {
struct SegHeader;
class ReaderChild;
}  // namespace detail

/// What a reader process may spend on one file. Memory: beyond what the program takes by itself.
struct ReaderLimits {
  std::uint64_t memory_bytes = 0;  ///< 256 MiB and three times the file
  double cpu_s = 0.0;              ///< 1.5 s, and 1 s for every 32 MiB of decoded pixels or 4 MiB of an archive
};
ReaderLimits limitsFor(std::uint64_t fileBytes, std::uint64_t decodedBytes);

/// A file that is parsed and decoded in a process of its own: glisson-reader, started when it is first needed and used
/// again for the next file. A crash, a hang or memory beyond the limits ends that process and becomes a reason.
/// Every call throws RefusedFile, with that reason; and where the program is not there (series.h: readerProgram).
class IsolatedFile {
 public:
  explicit IsolatedFile(const std::filesystem::path& file);
  ~IsolatedFile();
  IsolatedFile(const IsolatedFile&) = delete;
  IsolatedFile& operator=(const IsolatedFile&) = delete;

  /// Header of an image, checked again on this side.
  ImageHeader header();
  /// Stored pixels of one frame, little endian; frameBytes of them. Of a Segmentation: one byte a pixel.
  /// header() or segmentation() must have been asked for before.
  std::vector<std::uint8_t> frame(int number, std::uint64_t frameBytes);
  /// Contours of a structure set; header of a Segmentation. Checked again on this side.
  StructureSet structures();
  detail::SegHeader segmentation();
  /// Paths that a DICOMDIR lists, as parts from its folder on.
  std::vector<std::vector<std::string>> directory();

  /// One entry of an archive: its bytes come in pieces.
  struct EntrySink {
    /// Whether the bytes of this entry are wanted.
    std::function<bool(const std::string& name)> begin;
    std::function<void(const char* bytes, std::size_t count)> data;
    std::function<void(const std::string& name, const std::string& reason)> refused;
  };
  void unpack(const EntrySink& sink);

 private:
  std::string ask(std::uint32_t request, const std::string& payload, std::uint64_t decodedBytes,
                  std::uint64_t largestAnswer);
  void start();

  std::filesystem::path file_;
  std::uint64_t fileBytes_ = 0;
  std::unique_ptr<detail::ReaderChild> process_;
  bool opened_ = false;
};

/// The layout of a plain file, which may be parsed here; nothing for others, which are for a reader process. Found by
/// our own code, which allocates nothing that the file asks for. Throws BadInput as readLayout does.
std::optional<FileLayout> plainLayout(ByteSource& source);

/// Whether the header of a plain file can be parsed here, and what it says; others go through a reader process.
/// Throws RefusedFile.
/// keep: where the process that parsed the file is put, to decode its pixels; stays empty where it was parsed here.
ImageHeader readHeaderSafely(const std::filesystem::path& file, std::unique_ptr<IsolatedFile>* keep = nullptr);

/// The same of a plain file only; nothing for others. May be called from several threads at a time.
std::optional<ImageHeader> readPlainHeader(const std::filesystem::path& file);

}  // namespace glisson::dicom
