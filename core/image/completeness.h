#pragma once

#include <filesystem>

namespace glisson::image {

/// ITK's NIfTI and MetaImage readers fill voxels that a truncated file lacks with zeros and say nothing; so the header
/// and the number of bytes behind it are checked before they are asked. Throws BadInput, naming the file: not a NIfTI-1
/// file of one piece, sheared or singular sform, unknown datatype, voxels that begin within the header, fewer bytes
/// than the header announces, damaged compressed data.
void checkNifti(const std::filesystem::path& file);

/// The same for a MetaImage (.mha, or .mhd with its data file beside it).
void checkMetaImage(const std::filesystem::path& file);

/// An NRRD header may name any file for its voxels, a device too: BadInput unless that is one regular file.
void checkNrrd(const std::filesystem::path& file);

}  // namespace glisson::image
