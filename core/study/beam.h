// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/beam.h"
#include "mechanics/problem.h"
#include "mechanics/tet_solve.h"
#include "study/beam_goals.h"
#include "study/rows.h"

namespace glisson::study {

/// How the root of the beam is held.
enum class Root {
  Clamped,     ///< every displacement is zero on the face x = 0: what the published study does
  PoissonFree  ///< u_x = 0 on the face; its shear force is applied as a parabolic traction, and soft springs that carry
               ///< no net force hold the rigid motions: what beam theory assumes
};

/// The validation cantilever, 50 × 10 × 10 mm, E 12 kPa, uniform body force along −z.
mechanics::Cantilever validationBeam(double poisson);

/// Its voxel model. cells: along x, y, z. Throws BadInput where poisson or tip_mm is not usable.
mechanics::Problem beamProblem(const BeamOptions& options, const Eigen::Vector3i& cells, Root root);

/// The same beam on tetrahedra, six per cell of problem = beamProblem(options, cells, root), with consistent loads.
mechanics::TetProblem beamOnTetrahedra(const BeamOptions& options, const mechanics::Problem& problem,
                                       mechanics::TetOrder order, mechanics::TetPattern pattern, Root root);

/// Downward deflection (mm) of the central axis relative to its root, at stations i L / 30, i = 0 ... 30.
std::vector<double> axisDeflection_mm(const mechanics::VoxelMesh& mesh, const mechanics::NodalField& u_m);

/// A converged three-dimensional deflection: the finest of three grids (cells halved twice, incompatible modes),
/// extrapolated station by station at the order that the tips show, kept between 1/2 and 4.
struct ConvergedBeam {
  std::vector<double> axis_mm;
  double uncertainty_mm = 0.0;  ///< largest change along the axis that the extrapolation made: an upper estimate
  double order = 0.0;           ///< observed
  int dofs = 0;                 ///< of the finest grid
  std::string grid;             ///< "120x24x24"
};
/// finest: cells over the height of the finest grid, divisible by 4.
ConvergedBeam convergedBeam(const BeamOptions& options, Root root, int finest, const Progress& progress = {});

/// The names of the three references, as in Row::reference.
inline constexpr const char* converged3d = "converged 3-D";
inline constexpr const char* timoshenko = "Timoshenko (Poisson-free root)";
inline constexpr const char* eulerBernoulli = "Euler-Bernoulli";

/// The validation beam: every method against its references.
struct BeamStudy {
  BeamOptions options;
  std::vector<Row> rows;  ///< every method against the three references; against Timoshenko with the Poisson-free root
  ConvergedBeam clamped, poissonFree;
  double load_N_m = 0.0;  ///< distributed load
  double eulerBernoulliTip_mm = 0.0, timoshenkoTip_mm = 0.0;
  double gapEulerBernoulliTip_mm = 0.0;   ///< 3-D clamped − Euler-Bernoulli at the tip: theory, not method
  double gapEulerBernoulliAxis_mm = 0.0;  ///< largest along the axis
  double gapTimoshenkoTip_mm = 0.0;       ///< 3-D with the Poisson-free root − Timoshenko at the tip
  double allowed_mm = 0.0164;             ///< 1 % of a 1.64 mm voxel
  std::vector<BeamGoal> goals;            ///< at 1 mm tip; Poisson's ratio .3, .45 and .49, quick: that of the options
  std::string summary() const;            ///< the references and their gaps, in lines
  std::string caption() const;            ///< the same in a few sentences, for the chart
};

/// Runs the study: voxel elements and mesh-free frames, the published method (Voronoi kernel, conjugate gradients
/// stopped at 200) and tetrahedra among them. Default: under a minute on two cores. Throws BadInput, Cancelled.
BeamStudy studyBeam(const BeamOptions& options, const Progress& progress = {});

}  // namespace glisson::study
