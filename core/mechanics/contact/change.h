// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/contact/contact_solve.h"

namespace glisson::mechanics {

/// A finite change of what a contact problem is made of. Cells and surface samples keep their numbers.
struct Change {
  std::vector<double> logModuli;  ///< per cell, x fastest: ln of the factor on Young's modulus; or empty
  double poisson = 0;             ///< added to Poisson's ratio of the body (not of its skin); held below .497
  bool shearKept = true;          ///< by `poisson`: the shear moduli stay, else Young's moduli do
  double logSupports = 0;         ///< ln of the factor on springs, bed and tethers
  double logSkin = 0;             ///< ln of the factor on skin or rind
  double force_N = 0;             ///< added to the force on the bar, where that is given
  Eigen::Vector3d barShift_m = Eigen::Vector3d::Zero();   ///< of the whole bar
  Eigen::Vector3d barTurn_rad = Eigen::Vector3d::Zero();  ///< rotation vector of bar and hoist about `pivot_m`
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();
  double outward_m = 0;             ///< by which the surface moves along its normals
  std::vector<double> growth_Pa_m;  ///< per cell: Young's modulus times cover that a surface further out adds; or empty
};

/// The problem with the change made.
ContactProblem changed(const ContactProblem& problem, const Change& change);

/// A bar turned about a point, then shifted.
RigidBar moved(const RigidBar& bar, const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad,
               const Eigen::Vector3d& pivot_m);

/// Per cell what a surface one metre further out adds to modulus times cover, Pa/m: the area of the surface in the cell
/// over its volume, times the modulus of the full cell. cover: fraction of each cell that is filled, x fastest. 0 where
/// a cell has no surface or is covered in full.
std::vector<double> growthOf(const ContactProblem& problem, const std::vector<float>& cover);

}  // namespace glisson::mechanics
