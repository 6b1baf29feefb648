// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Small: symmetric part of the displacement gradient; a rotation by θ shows as cos θ − 1. Biot: U − I of F = R U, free
/// of rotation, what large-deformation results are judged by; the same for small rotations.
enum class StrainMeasure { Small, Biot };

/// What a displacement does to each filled cell, at its centre.
struct CellMeasures {
  Eigen::Matrix<double, 6, Eigen::Dynamic> strain;  ///< xx yy zz xy yz zx, tensor components (not engineering)
  Eigen::VectorXd principalStrain;                  ///< largest |eigenvalue| of the strain
  Eigen::VectorXd rotation_deg;                     ///< angle of R in the polar decomposition F = R U
  Eigen::VectorXd volumeRatio;  ///< det F; the smallest of the centre and the eight corners, so that folding is seen
  Eigen::VectorXd meanVolumeRatio;  ///< mean of det F over the cell: deformed volume over volume at rest
};

/// u_m: 3 × nodeCount. The strain at the centre of a trilinear box is also its mean over the box. Throws BadArgument on
/// a wrong size, BadInput where u is not finite.
CellMeasures measureCells(const VoxelMesh& mesh, const NodalField& u_m, StrainMeasure measure = StrainMeasure::Small);

/// Strain, rotation and displacement of a body in a few numbers.
struct DeformationSummary {
  double maxStrain = 0.0;  ///< largest |principal strain|, unitless
  double p95Strain = 0.0;  ///< 95 % of the volume strains less
  double p99Strain = 0.0;
  double maxRotation_deg = 0.0;
  double fractionAbove10 = 0.0;  ///< of the volume with |principal strain| > 0.1
  std::size_t invertedCells = 0;
  double fractionCrushed = 0.0;  ///< of the volume, in cells that keep less than half of theirs
  std::size_t cellsLeftOut = 0;  ///< cells of which less than leastCovered belongs to the body
  double maxDisplacement_m = 0.0;
  double meanDisplacement_m = 0.0;  ///< over nodes
};
/// Over all filled cells, each with its whole volume. Throws as measureCells.
DeformationSummary summarise(const VoxelMesh& mesh, const NodalField& u_m,
                             StrainMeasure measure = StrainMeasure::Small);
DeformationSummary summarise(const CellMeasures& cells, const NodalField& u_m);

/// Cells that a surface cuts to less than this say nothing about the body: the little tissue in them hardly resists.
inline constexpr double leastCovered = 0.5;
/// The same where the surface cuts cells: covered holds the share of each filled cell that belongs to the body, 0 to 1.
/// Cells below leastCovered are left out, the others count for as much of the volume as they hold. Throws BadArgument
/// where covered has another length.
DeformationSummary summarise(const CellMeasures& cells, const NodalField& u_m, const std::vector<float>& covered);

/// How far linear elasticity can be believed.
struct Validity {
  bool linearTrusted = false;  ///< p95 strain < 0.10 and rotation < 15°: about 0.2 mm on a liver
  bool invalid = false;  ///< displacement larger than the body, or inverted cells: no picture should be drawn of it
  Diagnostics said;      ///< most serious first; empty when nothing is to be said
  std::vector<std::string> warnings;  ///< the same in words
};
Validity validity(const VoxelMesh& mesh, const DeformationSummary& summary);

/// Displacement at a point in the body's axes (m): trilinear in the filled cell that holds it. A point outside every
/// filled cell takes the nearest point of the nearest filled cell when that lies within half a cell along each axis
/// (surfaces do not follow voxels); otherwise nothing.
std::optional<Eigen::Vector3d> displacementAt(const VoxelMesh& mesh, const NodalField& u_m, const Eigen::Vector3d& p_m);

}  // namespace glisson::mechanics
