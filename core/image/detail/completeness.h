// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "image/grid.h"

namespace glisson::image {

/// ITK's MetaImage reader fills voxels that a truncated file lacks with zeros, reads as many numbers as a header
/// announces, and takes voxels from any file; so the header and the number of bytes behind it (of .mha, or of the data
/// file beside an .mhd) are checked before it is asked. doubts (may be null): a header without a place in the patient.
/// Throws BadInput, naming the file: no readable header, lists of another length than NDims asks for, a data file that
/// is not one plain file beside it, fewer bytes than it announces, damaged compressed data.
void checkMetaImage(const std::filesystem::path& file, Diagnostics* doubts);

/// What ITK passes over of the header of a file that checkMetaImage has seen: lengths in other units than millimetres
/// (DistanceUnits) are scaled; axes that are called otherwise than they lie, voxels without a size, and a size that no
/// image has are put into doubts (may be null). Throws BadInput for a unit of length that is not known, and for values
/// that mean something by a scale of their own (ElementToIntensityFunction).
void completeMetaImage(const std::filesystem::path& file, Grid& grid, Diagnostics* doubts);

/// Voxels that are far smaller or larger than those of any image of a patient: lengths in another unit than they seem.
void doubtVoxelSize(const Grid& grid, Diagnostics* doubts);

}  // namespace glisson::image
