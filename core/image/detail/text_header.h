// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glisson::image::detail {

/// The lines of text at the head of an NRRD or MetaImage file.
struct TextHeader {
  std::map<std::string, std::string> fields;  ///< of NRRD in lower case, e.g. "space directions"
  std::map<std::string, std::string> keys;    ///< of NRRD: the file's own "key:=value" lines
  std::uintmax_t bytes = 0;                   ///< where the voxels of a file of one piece begin

  /// Empty where the field is not there.
  std::string field(const std::string& name) const;
  /// The numbers of a field, or nothing where a word of it is none or is not finite.
  std::optional<std::vector<double>> numbers(const std::string& name) const;
};

/// Throw BadInput, naming the file: no such header, a line of more than 64 KiB, more than 2000 lines.
TextHeader readNrrdHeader(const std::filesystem::path& file);
TextHeader readMetaHeader(const std::filesystem::path& file);

/// The file beside a header that holds its voxels: one regular file, no link, with a plain name in the header's own
/// folder. Throws BadInput, naming the header, for every other.
std::filesystem::path voxelFile(const std::filesystem::path& header, const std::string& name);

}  // namespace glisson::image::detail
