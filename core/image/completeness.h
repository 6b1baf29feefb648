#pragma once

#include <filesystem>

#include "base/diagnostic.h"

namespace glisson::image {

/// ITK's MetaImage reader fills voxels that a truncated file lacks with zeros, reads as many numbers as a header
/// announces, and takes voxels from any file; so the header and the number of bytes behind it (of .mha, or of the data
/// file beside an .mhd) are checked before it is asked. doubts (may be null): a header without a place in the patient.
/// Throws BadInput, naming the file: no readable header, lists of another length than NDims asks for, a data file that
/// is not one plain file beside it, fewer bytes than it announces, damaged compressed data.
void checkMetaImage(const std::filesystem::path& file, Diagnostics* doubts);

}  // namespace glisson::image
