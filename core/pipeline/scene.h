// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/quantity.h"
#include "dicom/series.h"
#include "retraction/setup.h"
#include "uncertainty/sources.h"

namespace glisson::pipeline {

/// Where the body comes from.
struct GeometrySpec {
  enum class Kind { Box, Mask, Patient } kind = Kind::Box;
  Eigen::Vector3d size_mm = Eigen::Vector3d::Zero();  ///< Box
  Eigen::Vector3d cell_mm = Eigen::Vector3d::Zero();  ///< Box; Mask and Patient: 0 = a stated default
  std::filesystem::path file;                         ///< Mask
  std::filesystem::path background;                   ///< Mask: image to draw the overlays on; may be empty
  int label = 0;                                      ///< Mask; 0 = any non-zero
  std::filesystem::path mri, mre, roi;                ///< Patient: DICOM folder or file, volume, contours
  bool rigidRegistration = false;  ///< Patient: elastogram laid over the MRI by its magnitude images (breath-hold)
  std::string roiName;             ///< Patient: structure to take; empty = found by name
  dicom::RoleOverrides roles;      ///< Patient: of series, set by hand
  std::optional<StiffnessQuantity>
      mreQuantity;  ///< Patient: what the elastogram is; empty = what it says, else the shear modulus
  std::optional<std::string> mreUnit;        ///< Patient: its unit, where it does not say so itself
  std::optional<double> mreConfidenceScale;  ///< Patient: stored value of full confidence, as mreUnit
  bool overrideChecks = false;               ///< Patient: other patient, day or frame of reference is meant
};

/// Where the stiffness comes from.
struct MaterialSpec {
  enum class Kind { Uniform, Map, Mre, Atlas } kind = Kind::Atlas;
  double value_kPa = 0.0;  ///< Uniform
  StiffnessQuantity quantity = StiffnessQuantity::Youngs;
  std::filesystem::path map;  ///< Map
  std::string unit = "kPa";   ///< Map: "Pa", "kPa" or "<factor>kPa"
};

/// What is asked for. Nothing that is not asked for is computed.
struct OutputSpec {
  std::vector<Eigen::Vector3d> probes_mm;
  bool displacementField = false, vessels = false, overlay = false, report = false, sofa = false;
};

/// What the scene is compared with: the same body and load with one textbook modulus.
struct CompareSpec {
  double value_kPa = defaults::atlasShear.kPa();
  StiffnessQuantity quantity = StiffnessQuantity::Shear;
};

/// One declarative scene: schema "glisson/scene/1".
struct Scene {
  GeometrySpec geometry;
  MaterialSpec material;
  retraction::Setup setup;
  bool capsuleAsked = false;  ///< setup.capsule is what the scene says, not a default
  /// Settings that other settings may leave without use, as far as the text names them: "spread_mm", "shape",
  /// "model.element", "solver.iterations", "solver.tolerance", "solver.preconditioner".
  std::vector<std::string> named;
  bool names(const std::string& key) const { return std::find(named.begin(), named.end(), key) != named.end(); }
  std::optional<CompareSpec> compare;
  std::optional<uncertainty::Options> uncertainty;  ///< how sure the answer is; empty: not asked
  OutputSpec outputs;
  std::filesystem::path folder;  ///< relative paths of the file are resolved against this
};

/// Reads and checks a scene file, or the scene of a case (case.json or its folder, see case_folder.h). Comments (// and
/// /* */) are allowed. Throws BadInput that names the key and the line for an unknown key, a wrong type or unit, a
/// missing file or key; for a case also as readCase does.
Scene readScene(const std::filesystem::path& file);

/// The same from text; folder resolves relative paths.
/// name: what to call the text in messages, e.g. the file's name.
Scene parseScene(const std::string& text, const std::filesystem::path& folder, const std::string& name = "scene");

/// Kinematics by their word in a scene, and back. Throws BadArgument for an unknown word.
retraction::Kinematics kinematicsOf(const std::string& word);
std::string nameOf(retraction::Kinematics kinematics);

/// A scene as JSON text with every default written out; parseScene of it gives the same scene.
std::string toJson(const Scene& scene);

}  // namespace glisson::pipeline
