// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "inversion/invert.h"
#include "inversion/waves.h"

namespace glisson::pipeline {

/// Raw phase images as they lie on disk.
struct PhaseRequest {
  std::vector<std::filesystem::path> paths;  ///< volumes, folders of volumes (in order of name), or DICOM folders
  int directions = 1;  ///< of plain volumes, which must come direction by direction, offsets in order of time
  std::vector<Eigen::Vector3d> encodings_lps;  ///< one for each direction; empty: unknown
  std::optional<double> radiansPerUnit;        ///< empty: told from the values
};

/// Wave phases as read, in radians.
struct LoadedPhases {
  std::vector<inversion::PhaseOffsets> directions;
  std::optional<double> frequency_Hz;  ///< where the files say so
  std::string scale;                   ///< how values became radians, in words
  std::vector<std::string> warnings;
};

/// DICOM series know their direction and time step; plain volumes are parted evenly. Throws BadInput: nothing found, a
/// number of volumes that the directions do not divide, a scale that cannot be told.
LoadedPhases loadPhases(const PhaseRequest& request, const Progress& progress = {});

/// Writes stiffness.nii.gz (|G*|), storage, loss, shear_stiffness, spread (all kPa, 0 where there is no modulus),
/// confidence, and wave_<n>_real/_imag (rad). Returns the files.
std::vector<std::filesystem::path> writeInversion(const std::filesystem::path& folder,
                                                  const inversion::Inversion& inversion);

}  // namespace glisson::pipeline
