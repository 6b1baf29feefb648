// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "base/quantity.h"
#include "elastography/statistics.h"
#include "inversion/invert.h"
#include "inversion/waves.h"
#include "pipeline/phases.h"

namespace glisson::pipeline {

/// Raw phase images, and how they are to become stiffness.
struct InvertRequest {
  PhaseRequest phases;
  inversion::InversionOptions options;  ///< frequency_Hz 0: as the files say
  inversion::Unwrapping unwrapping = inversion::Unwrapping::Auto;
  std::filesystem::path mask;                         ///< voxels with signal; empty: found from the noise in time
  double confidence = defaults::confidenceThreshold;  ///< least one of voxels that count in the statistics, 0 to 1
};

/// What is known of the waves of one direction: fields of inversion::Waves::Direction.
struct WaveQuality {
  double noise_rad = 0.0, jumping = 0.0;
  bool spatiallyUnwrapped = false;
};

/// Stiffness from phase images, its statistics over the confident voxels, and what is doubtful about it.
struct InvertedPhases {
  std::size_t offsets = 0;  ///< of a vibration period
  std::string scale;        ///< how values became radians, in words
  std::vector<WaveQuality> directions;
  inversion::Inversion inversion;
  /// Of |G*|, Re, Im, density × wave speed², and of the spread of |G*|, kPa.
  elastography::Statistics stiffness, storage, loss, shear, spread;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
};

/// Throws BadInput as loadPhases, inversion::firstHarmonic and inversion::invert do, and where neither the request nor
/// the files tell the frequency.
InvertedPhases invertPhases(const InvertRequest& request, const Progress& progress = {});

}  // namespace glisson::pipeline
