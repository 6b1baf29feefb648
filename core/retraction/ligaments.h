// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "mechanics/contact/contact_solve.h"
#include "retraction/body.h"

namespace glisson::retraction {

std::string nameOf(LigamentName name);  ///< as in scenes: "falciform", "left-triangular", ...

/// A ligament as fibres from the body's surface to where it springs from; grid axes of the body, m.
struct LigamentFibres {
  LigamentName name = LigamentName::Other;
  double stiffness_N_per_mm = 0.0;
  double width_mm = 0.0;                  ///< longest side of its region across the fibres
  bool estimated = false;                 ///< the stiffness is not the scene's but made of width and length
  std::vector<mechanics::Tether> fibres;  ///< one per node of the region
};

/// The ligaments of a scene, in the order of its supports. Throws BadInput where a region holds no surface, or looks
/// into all directions alike and the scene does not say where the ligament springs from.
std::vector<LigamentFibres> ligamentsOf(const Body& body, const Setup& setup);

/// A note for each ligament whose stiffness was estimated.
Diagnostics estimatesOf(const std::vector<LigamentFibres>& ligaments);

/// What they pull with, from the forces of their fibres in order (N, grid axes).
std::vector<LigamentPull> pullsOf(const Body& body, const std::vector<LigamentFibres>& ligaments,
                                  const std::vector<Eigen::Vector3d>& fibre_N);

}  // namespace glisson::retraction
