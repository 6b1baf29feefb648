// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "retraction/setup.h"
#include "retraction/simulate.h"

namespace glisson::exchange {

/// Vessel centrelines that the liver carries along.
struct SofaLandmarks {
  std::vector<Eigen::Vector3d> points_lps_mm;
  std::vector<std::array<int, 2>> edges;  ///< neighbouring points; may be empty
};

/// How the example scene steps through time. Where the scene itself is dynamic, its own step, end and damping are used.
struct SofaOptions {
  double dt_s = 0.05;
  int steps = 100;                     ///< after which a static load has come to rest
  double rayleighStiffness_s = 0.1;    ///< overdamps all but rigid modes, so that rest is reached soon
  std::size_t matrixDofLimit = 30000;  ///< above, K and M are not written beside the node
};

/// What was exported for SOFA.
struct SofaExport {
  std::vector<std::filesystem::path> files;  ///< what was written; the scene to run first
  std::vector<std::string> notes;            ///< where SOFA's model differs from the scene's, in words
};

/// Writes a scene for SOFA (names and data as of 26.06) into a folder, made where it is missing:
///   retraction.scn     the retraction, complete in itself:  runSofa -g batch -n <steps> retraction.scn
///   liver_node.xml     the patient's node alone, for `<include href="liver_node.xml"/>` in a scene of one's own
///   liver.vtk          hexahedra (or linear tetrahedra where the scene has them) with one Young's modulus each
///   vessels.vtk        landmarks, mapped into the liver; left out where there are none
///   K.mtx, M.mtx       assembled matrices of the scene's own element in Matrix Market form
///   springs.mtx        spring supports in the same numbering
///   README.txt         units, how to run, why nothing moves where nothing moves
/// mm, kg, s: stress in kPa, force in mN. Points in LPS. Supports become FixedProjectiveConstraint (all axes),
/// PartialFixedProjectiveConstraint (some), linear movements (prescribed displacements) and RestShapeSpringsForceField;
/// loads become ConstantForceField with one force per node.
/// Throws BadInput where the scene cannot be said in SOFA's terms: springs along the surface normal on an oblique grid,
/// a Poisson's ratio below 0; and whatever retraction::toMechanics throws.
SofaExport writeSofa(const std::filesystem::path& folder, const retraction::Model& model,
                     const retraction::Setup& setup, const SofaLandmarks& landmarks, const SofaOptions& options = {});

}  // namespace glisson::exchange
