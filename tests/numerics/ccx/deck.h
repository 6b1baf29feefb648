// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "mechanics/problem.h"

namespace glisson::ccx {

/// A static problem for CalculiX under a body force. SI units.
struct Deck {
  std::string element;       ///< "C3D8", "C3D8I", "C3D10"
  Eigen::Matrix3Xd nodes_m;  ///< 3 × nodes
  Eigen::MatrixXi elements;  ///< nodes per element × elements, from 0, in CalculiX's order
  Eigen::VectorXd E_Pa;      ///< one per element
  double poisson = 0.3;
  std::vector<mechanics::Fixation> fixations;
  Eigen::Vector3d force_N_m3 = Eigen::Vector3d::Zero();
  bool largeDeformation = false;
};

/// CalculiX is on the path.
bool installed();

/// Writes the deck, runs CalculiX (one thread) and reads the displacement of every node, m, 3 × nodes, 7 digits.
/// Throws std::runtime_error where it fails or leaves nodes out.
mechanics::NodalField run(const Deck& deck);

}  // namespace glisson::ccx
