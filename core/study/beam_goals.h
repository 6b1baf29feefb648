// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::study {

/// The validation beam's load and extent.
struct BeamOptions {
  double poisson = 0.45;
  double tip_mm = 1.0;  ///< Euler-Bernoulli tip deflection, which sets the load
  bool quick = false;   ///< fewer methods and resolutions, coarser references
};

/// A figure that the project wants to reach on the validation beam, and what was measured.
struct BeamGoal {
  std::string what;      ///< method, degrees of freedom
  double poisson = 0.0;  ///< Poisson's ratio
  std::string quantity;  ///< "mm" (at most `limit`), "times" (at least `limit`)
  double value = 0.0, limit = 0.0;
  std::string beside;  ///< other figures that belong to it
  bool met() const { return quantity == "mm" ? value <= limit : value >= limit; }
  std::string line() const;  ///< "met     voxel FEM ..., Poisson's ratio 0.3: 0.0049 mm, at most 0.0164"
};

/// Every goal at every Poisson's ratio, 1 mm tip: voxel FEM at 1.67 mm, mesh-free models of at most 1800 degrees of
/// freedom, stretch goals at 720, and the distance to the published Voronoi frames at equal degrees of freedom. Errors
/// are the largest along the axis. The ratio is given twice: against 3-D, where the error of the voxels under the
/// frames is part of both, and (beside) against these voxels, which is what the frames alone lose.
std::vector<BeamGoal> beamGoals(const std::vector<double>& poissons, const Progress& progress = {});

}  // namespace glisson::study
