// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <utility>

#include "base/error.h"
#include "retraction/setup.h"

namespace glisson::session {

/// Every way to discretise a liver that a scene can ask for, as the Model page offers them.
enum class Method {
  HexIncompatible,
  HexBBar,
  Hex,
  TetQuadratic,
  TetLinear,
  DelaunayQuadratic,
  DelaunayLinear,
  WendlandAffine,
  WendlandQuadratic,
  Voronoi,
  MovingLeastSquares
};

/// What the retractor is given: a force (the liver's weight, or any), or its way from first touch.
enum class Drive { LiverWeight, Force, Travel };

/// Who answers the equations.
enum class Solver { Auto, Cg, Multigrid, Factorised, Condensed };

/// Names in a case. "fem-hex", "fem-tet" and "meshfree" are those of the scene's own defaults.
inline constexpr std::array<std::pair<Method, const char*>, 11> methodNames = {{
    {Method::HexIncompatible, "fem-hex"},
    {Method::HexBBar, "fem-hex-bbar"},
    {Method::Hex, "fem-hex-h8"},
    {Method::TetQuadratic, "fem-tet"},
    {Method::TetLinear, "fem-tet-t4"},
    {Method::DelaunayQuadratic, "fem-tet-delaunay-t10"},
    {Method::DelaunayLinear, "fem-tet-delaunay-t4"},
    {Method::WendlandAffine, "meshfree"},
    {Method::WendlandQuadratic, "meshfree-quadratic"},
    {Method::Voronoi, "meshfree-voronoi"},
    {Method::MovingLeastSquares, "meshfree-mls"},
}};
inline constexpr std::array<std::pair<Solver, const char*>, 5> solverNames = {{{Solver::Auto, "auto"},
                                                                               {Solver::Cg, "cg"},
                                                                               {Solver::Multigrid, "multigrid"},
                                                                               {Solver::Factorised, "factorised"},
                                                                               {Solver::Condensed, "condensed"}}};
inline constexpr std::array<std::pair<retraction::Kinematics, const char*>, 4> kinematicsNames = {
    {{retraction::Kinematics::Linear, "linear"},
     {retraction::Kinematics::Corotational, "corotational"},
     {retraction::Kinematics::Hyperelastic, "hyperelastic"},
     {retraction::Kinematics::Auto, "auto"}}};
inline constexpr std::array<std::pair<retraction::ContactKind, const char*>, 2> contactNames = {
    {{retraction::ContactKind::Rigid, "rigid"}, {retraction::ContactKind::Patch, "patch"}}};
inline constexpr std::array<std::pair<retraction::BarShape, const char*>, 2> shapeNames = {
    {{retraction::BarShape::Straight, "straight"}, {retraction::BarShape::Hook, "hook"}}};
inline constexpr std::array<std::pair<Drive, const char*>, 3> driveNames = {
    {{Drive::LiverWeight, "liver-weight"}, {Drive::Force, "force"}, {Drive::Travel, "travel"}}};
/// Whether the scene can be one that linear theory answers, in time steps or condensed.
inline bool mayBeLinear(retraction::Kinematics k) {
  return k == retraction::Kinematics::Linear || k == retraction::Kinematics::Auto;
}

/// The name of a choice, and the choice of a name. what: for the message of the BadInput where no choice has that name.
template <typename Choice, std::size_t n>
std::string nameIn(const std::array<std::pair<Choice, const char*>, n>& names, Choice choice) {
  for (const auto& [c, name] : names)
    if (c == choice) return name;
  return names.front().second;
}
template <typename Choice, std::size_t n>
Choice named(const std::array<std::pair<Choice, const char*>, n>& names, const std::string& name, const char* what) {
  for (const auto& [c, known] : names)
    if (name == known) return c;
  throw BadInput(std::string("the case asks for the ") + what + " '" + name.substr(0, 40) +
                 "', which this version does not know");
}

inline bool isHex(Method m) {
  return m == Method::HexIncompatible || m == Method::HexBBar || m == Method::Hex;
}
inline bool isDelaunay(Method m) {
  return m == Method::DelaunayQuadratic || m == Method::DelaunayLinear;
}
inline bool isMeshfree(Method m) {
  return m == Method::WendlandAffine || m == Method::WendlandQuadratic || m == Method::Voronoi ||
         m == Method::MovingLeastSquares;
}

/// The scene's model of a method.
inline retraction::ModelSpec modelOf(Method m) {
  retraction::ModelSpec spec;
  if (isMeshfree(m)) {
    spec.kind = retraction::ModelKind::Meshfree;
    spec.meshfree.kernel = m == Method::Voronoi              ? mechanics::Kernel::Voronoi
                           : m == Method::MovingLeastSquares ? mechanics::Kernel::Mls
                                                             : mechanics::Kernel::Wendland;
    spec.meshfree.order = m == Method::WendlandQuadratic ? 2 : 1;
  } else if (isHex(m)) {
    spec.element = m == Method::Hex       ? mechanics::HexElement::H8
                   : m == Method::HexBBar ? mechanics::HexElement::BBar
                                          : mechanics::HexElement::Incompatible;
  } else {
    spec.kind = retraction::ModelKind::FemTet;
    spec.delaunay = isDelaunay(m);
    spec.quadraticTets = m == Method::TetQuadratic || m == Method::DelaunayQuadratic;
  }
  return spec;
}

}  // namespace glisson::session
