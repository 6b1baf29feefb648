// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "image/volume.h"
#include "mechanics/contact/cell_kernel.h"
#include "mechanics/meshfree.h"
#include "mechanics/problem.h"
#include "mechanics/time_scheme.h"

namespace glisson::retraction {

/// Part of the outer surface (or of the nodes) of the body, in the scene's own words.
/// face: "x-" ... "z+": the voxel faces on that bounding plane of the body (LPS axes for masks and patients).
/// surface: "posterior", "anterior", "superior", "inferior", "left", "right" (every outer voxel face whose outward
/// normal is that direction, wherever it lies), "outer", "inner" (faces of enclosed cavities), "all".
struct FaceRegion {
  std::string face;
};
struct SurfaceRegion {
  std::string surface;
};
struct BoxRegion {
  Eigen::Vector3d low_mm, high_mm;
};  ///< nodes and faces inside, borders included
struct PlaneRegion {
  Eigen::Vector3d point_mm, normal;
  double tolerance_mm;
};  ///< within tolerance of the plane
struct MaskRegion {
  std::filesystem::path file;
  int label = 0;
};  ///< what lies in a voxel of the mask (label 0: any)
using Region = std::variant<FaceRegion, SurfaceRegion, BoxRegion, PlaneRegion, MaskRegion>;

/// Folds of peritoneum that tie the liver to the diaphragm and the abdominal wall.
enum class LigamentName { Falciform, Coronary, LeftTriangular, RightTriangular, Other };
/// A ligament as fibres from the liver to where they spring from.
struct LigamentSpec {
  LigamentName name = LigamentName::Other;
  /// Of the whole ligament along its fibres. Empty: two sheets of peritoneum, each as stiff as the capsule of which it
  /// is a part (Capsule::tension_N_per_mm), over the width of the region and the length of the fibres.
  std::optional<double> stiffness_N_per_mm;
  double length_mm = 0.0;  ///< of its fibres, from the liver to where they spring from
  double slack_mm = 0.0;   ///< by which they lengthen before they pull
  std::optional<Eigen::Vector3d>
      towards;            ///< unit, LPS, to where they spring from; empty: the region's mean outward normal
  bool twoSided = false;  ///< pushes as well
  static constexpr double falciformLength_mm = 30.0, otherLength_mm = 15.0;  ///< defaults; our own estimates
};

/// What holds a part of the body.
struct SupportSpec {
  enum class Kind { Fixed, Spring, Ligament } kind = Kind::Fixed;
  Region region;
  std::array<bool, 3> axes = {true, true, true};              ///< Fixed: which components are held
  Eigen::Vector3d displacement_mm = Eigen::Vector3d::Zero();  ///< Fixed: held at this
  double stiffness_kPa_per_mm = 0.0;                          ///< Spring: Winkler foundation
  bool normalOnly = false;                                    ///< Spring: resists along the face normal only
  bool unilateral = false;  ///< Spring: presses along the face normal, does not pull; large deformation only
  double tangential = 0.0;  ///< unilateral Spring: share of its stiffness that acts along the face, pressed or not
  LigamentSpec ligament{};  ///< Ligament; large deformation only
};

/// A force on all of the body, such as a weight.
struct BodyForce {
  Eigen::Vector3d N_per_m3;
};
/// A force per area on a part of the surface.
struct Traction {
  Region region;
  Eigen::Vector3d kPa;
  bool follows = false;  ///< large deformation: per deformed area, and turns with the material of its faces
};
struct Pressure {
  Region region;
  double kPa;
  bool follows = false;  ///< large deformation: stays normal to the deformed faces and grows with them
};                       ///< positive pushes against the outward normal
/// How the bar meets the liver. Rigid: a body of its own that pushes and does not pull, without friction. Patch: its
/// force spread over the surface at rest.
enum class ContactKind { Rigid, Patch };
/// Straight: a capsule, length_mm between the centres of its round ends. Hook: the same length bent to an arc of a
/// quarter turn across the hoist, as the blade of a Nathanson retractor.
enum class BarShape { Straight, Hook };
/// A retractor's bar, where it lies, and how it is driven.
struct Retractor {
  /// Both ends accepted.
  struct Range {
    double least, most;
  };
  /// What is accepted: an instrument, and not a wire or a wall.
  static constexpr Range diameters_mm{1.0, 100.0}, lengths_mm{1.0, 300.0}, spreads_mm{0.0, 100.0}, forces_N{0.0, 500.0};
  double diameter_mm = 10.0;
  double length_mm = 80.0;
  double spread_mm = 10.0;  ///< tissue wraps round the bar: standard deviation of the pressure beyond it; 0 = bare bar
  std::optional<Eigen::Vector3d> at_mm;  ///< empty: inferior right lobe, found from geometry
  std::optional<double> force_N;         ///< empty: the liver's weight
  Eigen::Vector3d direction{0, -1, 0};  ///< of the hoist, LPS; "transverse" = towards anterior, in the transverse plane
  std::optional<Eigen::Vector3d> axis;  ///< of the bar, LPS; empty: from geometry (a rigid bar), x (a patch)
  /// Empty, as a scene that does not say it has it: rigid where model and analysis offer it, else patch.
  std::optional<ContactKind> contact = ContactKind::Patch;
  std::optional<double> travel_mm;  ///< the bar's way from its first touch, instead of a force
  BarShape shape = BarShape::Straight;

  Eigen::Vector3d patchAxis() const { return axis.value_or(Eigen::Vector3d(1, 0, 0)); }
};
using LoadSpec = std::variant<BodyForce, Traction, Pressure, Retractor>;

/// Elements of the body: hexahedra, tetrahedra, or frames without a mesh.
enum class ModelKind { FemHex, FemTet, Meshfree };
/// How the body is made of elements.
struct ModelSpec {
  ModelKind kind = ModelKind::FemHex;
  mechanics::HexElement element = mechanics::HexElement::Incompatible;
  bool quadraticTets = false;
  bool delaunay = false;                     ///< tetrahedra follow the organ's smooth surface; else six per voxel
  double cell_mm = 10.0, toolCell_mm = 4.0;  ///< Delaunay: edges of the tetrahedra, and near the retractor
  mechanics::MeshfreeOptions meshfree;
};

/// At rest, or in motion from rest.
struct AnalysisSpec {
  bool dynamic = false;
  double h_ms = 1.0;
  double end_s = 2.0;
  mechanics::TimeScheme scheme = mechanics::TimeScheme::ImplicitEuler;
  double spectralRadius = 0.8;                  ///< of generalised alpha
  std::array<double, 2> rayleigh = {0.0, 0.0};  ///< alpha 1/s, beta s
  double stopWhenSteady = 1e-6;  ///< relative unbalance and motion per step at rest (mechanics::isAtRest); 0 = never
};

/// How strain follows from displacement. Auto: linear where that is right to 0.2 mm, else hyperelastic.
enum class Kinematics { Linear, Corotational, Hyperelastic, Auto };

/// How the capsule is borne. Cells: by a layer of 3 mm below the surface, in all directions, whatever the cells.
/// Membrane: in the plane of the surface, and in tension only; cells of a few millimetres then fold one by one under a
/// bar, where the true capsule wrinkles finer than they are, so that soft livers take many more iterations or find no
/// answer.
enum class CapsuleForm { Cells, Membrane };

/// Glisson's capsule: stiff skin of the liver.
struct Capsule {
  /// Young's modulus times thickness. Default: porcine capsule, 8.2 MPa at small strain [umale2011characterization]
  /// times 30 µm, the lower end of 50 to 90 µm, as its curve is J-shaped.
  double tension_N_per_mm = 0.25;
  CapsuleForm form = CapsuleForm::Cells;
};

/// All of a mechanics scene but its geometry and stiffness.
struct Setup {
  double poisson = defaults::poisson;
  Density density = defaults::liverDensity;
  std::vector<SupportSpec> supports;
  std::vector<LoadSpec> loads;
  ModelSpec model;
  Kinematics kinematics = Kinematics::Linear;
  AnalysisSpec analysis;
  mechanics::SolverOptions solver;
  /// Hyperelastic: which neo-Hookean energy. Empty: with a rigid bar the polynomial one, which stays defined where a
  /// state on the way folds a cell; else the logarithmic one.
  std::optional<mechanics::SolidLaw> law;
  std::optional<Capsule> capsule;  ///< rigid contact only; empty: none
  bool condensed = false;  ///< answer through the condensed response of the full model instead of the solve itself
  std::uint64_t seed = 1;
};

/// The same scene with its retractor as a patch of pressure and linear kinematics for auto: for what asks for loads on
/// nodes (matrices, condensed responses, other programs). A bar that is given its travel takes the liver's weight.
Setup withPatch(Setup setup);

/// withPatch, and without what no other program's files can say: ligaments are left out, springs that only press pull
/// as well, loads do not follow their faces.
Setup exportable(Setup setup);
/// What of a scene `exportable` changes.
Diagnostics notExportable(const Setup& setup);

}  // namespace glisson::retraction
