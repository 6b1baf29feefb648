// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "elastography/registration.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {

/// Corrects a shift between two breath-holds: lays the magnitude images of the elastography acquisition over the MRI
/// (elastography/registration.h) and moves the grids of the stiffness map and its confidence with them; values are not
/// resampled. Undone by moving the grids with X_fixed_moving⁻¹. magnitude: a volume or DICOM path; empty: the magnitude
/// images of the acquisition that was loaded. Adds a sentence to mre.warnings. Throws BadInput where there is no
/// magnitude image, or the images cannot be laid over each other.
elastography::Registration fitToMri(LoadedStiffness& mre, const std::filesystem::path& mrePath,
                                    const std::filesystem::path& magnitude, const image::ScalarVolume& mri,
                                    const Progress& progress = {});

}  // namespace glisson::pipeline
