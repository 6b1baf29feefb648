// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "exchange/sofa.h"
#include "retraction/body.h"

namespace glisson::exchange::detail {

/// Nodes held along the same axes at the same displacement. Axes and displacement are LPS.
struct SofaHeld {
  std::array<bool, 3> axis{};
  Eigen::Vector3d displacement_mm = Eigen::Vector3d::Zero();
  std::vector<int> nodes;
};

/// Springs to the rest position that act along the same axes.
struct SofaSprings {
  std::array<bool, 3> axis{};
  std::vector<int> nodes;
  std::vector<double> stiffness_mN_mm;
};

struct SofaLoad {
  std::string name;
  std::vector<int> nodes;
  std::vector<Eigen::Vector3d> force_mN;
};

/// A scene in SOFA's terms: mm, kg, s, kPa, mN; LPS.
struct SofaScene {
  bool tetrahedra = false;
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<std::vector<int>> elements;  ///< VTK node order, positively oriented
  std::vector<double> youngs_kPa;          ///< per element
  std::vector<double> mass_kg;             ///< per node
  double poisson = 0.45;
  std::string method = "small";  ///< of the force field
  std::vector<SofaHeld> held;
  std::vector<SofaSprings> springs;
  std::vector<SofaLoad> loads;
  SofaLandmarks landmarks;
  double dt_s = 0.0;
  int steps = 0;
  double rayleighStiffness_s = 0.0, rayleighMass_1_s = 0.0;
  bool matrices = false;  ///< K.mtx and M.mtx lie beside the node
  std::vector<std::string> notes;
};

/// Throws as writeSofa does.
SofaScene sofaScene(const retraction::Body& body, const retraction::Model& model, const retraction::Setup& setup,
                    const retraction::MechanicsScene& mechanics, const SofaLandmarks& landmarks,
                    const SofaOptions& options);

/// The patient's node: mesh, state, mass, force field, supports, vessels; with loads where withLoads is set.
std::string sofaNode(const SofaScene& scene, bool withLoads, const std::string& indent);
/// The root node around it.
std::string sofaExample(const SofaScene& scene);
std::string sofaReadme(const SofaScene& scene);
/// Legacy ASCII VTK unstructured grids.
std::string sofaMesh(const SofaScene& scene);
std::string sofaLandmarkMesh(const SofaLandmarks& landmarks);

}  // namespace glisson::exchange::detail
