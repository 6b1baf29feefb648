// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "mechanics/loads.h"
#include "mechanics/problem.h"
#include "study/stability.h"

namespace glisson::study {

/// What a case found.
struct Outcome {
  bool good = false;
  bool refusal = false;  ///< the right answer was a refusal
  int iterations = 0;
  double residual = 0.0;
  std::string detail;

  /// Counts a solve's report in.
  void add(const mechanics::SolveReport& r) {
    iterations = std::max(iterations, r.iterations);
    if (!(r.residual <= residual)) residual = r.residual;
  }
};

/// A case of the sweep, and what should come of it.
struct ExtremeScene {
  std::string name, expectation;
  std::function<Outcome(const Progress&)> run;
};

/// Cases of one kind.
using Scenes = std::vector<ExtremeScene>;
Scenes motionScenes(const StabilityOptions& options);      ///< rigid motions, oscillator, steps, limits of dynamics
Scenes bendingScenes(const StabilityOptions& options);     ///< beams, own weight, conjugate gradients stopped at 200
Scenes contrastScenes(const StabilityOptions& options);    ///< inclusions, random moduli, bars, spheres
Scenes matrixScenes(const StabilityOptions& options);      ///< symmetry, zero modes, balance, threads, scales, sizes
Scenes refusalScenes(const StabilityOptions& options);     ///< unusable moduli, supports, islands
Scenes meshScenes(const StabilityOptions& options);        ///< tetrahedra and mesh-free sites, good and bad
Scenes contactScenes(const StabilityOptions& options);     ///< a rigid bar under a soft lobe: poses, stiffnesses
Scenes retractionScenes(const StabilityOptions& options);  ///< whole scenes: comparison, retractor, validity

/// "text 1.234 text": numbers with four digits.
template <typename... Parts>
std::string words(const Parts&... parts) {
  std::ostringstream t;
  t.precision(4);
  (t << ... << parts);
  return t.str();
}

/// Runs something that must be refused as bad input, with every needle in the message.
Outcome refused(const std::function<void()>& act, const std::vector<std::string>& needles);

/// A box of equal cells and one modulus; SI.
mechanics::VoxelBody solidBox(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_m, double E_Pa, double poisson);
/// Sets every modulus from the cell's centre (m).
void paint(mechanics::VoxelBody& body, const std::function<double(const Eigen::Vector3d&)>& E_Pa);
std::vector<int> nodesWhere(const mechanics::VoxelMesh& mesh,
                            const std::function<bool(const Eigen::Vector3d&)>& chosen);
/// Exterior faces on one side of the grid: 0 x−, 1 x+, ... 5 z+.
std::vector<mechanics::Face> facesOn(const mechanics::VoxelMesh& mesh, int side);
/// Fixes one side.
std::vector<mechanics::Fixation> clampSide(const mechanics::VoxelMesh& mesh, int side,
                                           const std::array<bool, 3>& axis = {true, true, true});
/// Largest |a − b| over largest |b|.
double relativeDifference(const mechanics::NodalField& a, const mechanics::NodalField& b);

}  // namespace glisson::study
