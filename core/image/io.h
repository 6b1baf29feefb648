// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "image/volume.h"

namespace glisson::image {

/// Reads a NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd) or MetaImage (.mha, .mhd) volume, values scaled as the
/// header says, geometry in LPS mm. A 4-D file with one time point is taken as 3-D. The header is checked before
/// anything is allocated. doubts gets what two programs may read differently: a place in the patient that is not said,
/// or said twice (NIfTI's qform and sform). Throws BadInput (unknown extension, not readable, no 3-D scalar image, bad
/// geometry, truncated data).
ScalarVolume readVolume(const std::filesystem::path& file, Diagnostics* doubts = nullptr);

/// The same for integer labels; values that are not integers (to 1e-3) are a BadInput.
LabelMap readLabelMap(const std::filesystem::path& file, Diagnostics* doubts = nullptr);

/// Voxels equal to label (or any non-zero voxel where label is 0) as a mask. Throws BadInput where none is left, naming
/// the labels that are there.
Mask readMask(const std::filesystem::path& file, int label = 0, Diagnostics* doubts = nullptr);

/// Whether the extension is one that readVolume takes.
bool isVolumeFile(const std::filesystem::path& file);

/// Writes by extension (.nii, .nii.gz, .nrrd, .mha); written beside, then renamed, so that a failure leaves the old
/// file. A ScalarVolume is written as 32-bit float, a Mask as 8-bit, a LabelMap as 32-bit integer, a DisplacementField
/// as a vector image of 32-bit floats (.nrrd or .mha only: NIfTI readers disagree on the axes of vectors). Throws
/// BadInput where the folder cannot be written to.
void writeVolume(const std::filesystem::path& file, const ScalarVolume& volume);
void writeVolume(const std::filesystem::path& file, const Mask& mask);
void writeVolume(const std::filesystem::path& file, const LabelMap& labels);
void writeVolume(const std::filesystem::path& file, const DisplacementField& u_mm);

}  // namespace glisson::image
