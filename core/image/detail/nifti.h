// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "base/diagnostic.h"
#include "image/grid.h"

namespace glisson::image::detail {

/// A NIfTI-1 file of one piece (.nii, .nii.gz) with one value per voxel: value = slope · stored + intercept.
struct NiftiFile {
  Grid grid;                ///< LPS mm: of the sform where it is set, else of the qform, else along the axes from 0
  int datatype = 0;         ///< NIfTI-1 code
  std::vector<char> bytes;  ///< as stored, in the order of this machine
  double slope = 1.0, intercept = 0.0;
  Diagnostics doubts;  ///< no form at all; forms that place the volume apart; steps that differ
};

/// Read here and not by ITK 5.2, which for good files of scanners takes the spacing of pixdim against that of the
/// sform, refuses origins some 600 mm from the isocentre by rounding, turns not-a-number into zero, fills what a
/// truncated file lacks with zeros, and reads damaged vox_offsets as they come, all without a word. Throws BadInput,
/// naming the file: not such a file; sheared, singular or not finite axes; unknown datatype; several values per voxel;
/// voxels that begin within the header; fewer bytes than the header announces or more than mostBytes.
NiftiFile readNifti(const std::filesystem::path& file, double mostBytes);

}  // namespace glisson::image::detail
