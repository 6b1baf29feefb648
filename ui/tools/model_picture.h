// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/triangle_mesh.h"

namespace glisson::tools {

/// What is known of a place that was proposed for a rigid bar: that it bears the load is proved by the run, which goes
/// on to the next place where it does not.
enum class BarProof { None, ByTheRun, Proved };

/// The bar as it lies against the liver, LPS.
struct BarPlace {
  Eigen::Vector3d contact_lps = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();        ///< unit, across the direction
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitY();  ///< of the hoist, unit
  double diameter_mm = 10.0, length_mm = 80.0;
  bool rigid = false;  ///< a body of its own at first touch; else a patch of pressure
  BarProof proof = BarProof::None;
  std::vector<Eigen::Vector3d> line_lps{};  ///< centre line of a rigid bar that is bent; empty: straight
};

/// What a model is made of, before anything is solved.
struct ModelPicture {
  anatomy::TriangleMesh liver, vessels;
  Eigen::VectorXf shear_kPa;                               ///< per vertex of the liver, of the cell below it
  double least_kPa = 0.0, most_kPa = 0.0, mean_kPa = 0.0;  ///< shear modulus over the cells
  bool fromMre = false;                                    ///< else the same modulus everywhere
  Eigen::Matrix3Xd sites_lps;  ///< nodes of the voxels, or mesh-free sites; not all where there are too many
  long long sites = 0;         ///< how many there are
  bool meshfree = false;
  struct Support {
    Eigen::Matrix3Xd points_lps;  ///< nodes that it holds
    bool fixed = false;           ///< else springs
    std::string name;             ///< in the scene's words
    std::string problem;          ///< why it holds nothing, in words; empty where it does
  };
  std::vector<Support> supports;
  std::optional<BarPlace> bar;
  std::string barProblem;  ///< why there is no bar
};

}  // namespace glisson::tools
