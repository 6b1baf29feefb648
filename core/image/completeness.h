#pragma once

#include <filesystem>

namespace glisson::image {

/// ITK's MetaImage reader fills voxels that a truncated file lacks with zeros and says nothing; so the header and the
/// number of bytes behind it (of .mha, or of the data file beside an .mhd) are checked before it is asked. Throws
/// BadInput, naming the file: no readable header, fewer bytes than it announces, damaged compressed data.
void checkMetaImage(const std::filesystem::path& file);

/// An NRRD header may name any file for its voxels, a device too: BadInput unless that is one regular file.
void checkNrrd(const std::filesystem::path& file);

}  // namespace glisson::image
