// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "image/volume.h"
#include "mechanics/contact/contact_solve.h"
#include "mechanics/problem.h"
#include "retraction/linear_gap.h"
#include "retraction/setup.h"

namespace glisson::retraction {

class SmoothBody;

/// The body of a scene: cells on a grid in the patient frame (a box has its own frame: identity axes, and spans [0,
/// size]). A cell is a voxel: its centre is the voxel's centre.
struct Model {
  image::ScalarVolume youngs_kPa;  ///< Young's modulus per cell, 0 outside the body
  double poisson = defaults::poisson;
  Density density = defaults::liverDensity;
  std::size_t cells = 0;
  double volume_mL = 0.0;
  double mass_kg = 0.0;
  std::string stiffness = "own";  ///< which of two this is, as messages and codes name it: "own" or "atlas"
  /// The body behind the cells where it comes from a mask, shared by all models of it; null for boxes, and where no
  /// retractor asks for it.
  std::shared_ptr<const SmoothBody> smooth;
};

/// Counts cells, volume and mass; throws BadInput naming voxel and slice where a modulus is not usable, or where the
/// body is not between 0.03 and 0.6 m long and checkSize is set.
Model makeModel(image::ScalarVolume youngs_kPa, double poisson, Density density, bool checkSize);

/// What the rigid bar and the liver do to each other at the end, mm, N, kPa, LPS.
struct RigidContact {
  mechanics::ContactOutcome outcome = mechanics::ContactOutcome::Reached;
  double travel_mm = 0.0;                               ///< of the bar from its first force, along the hoist
  double capacity_N = 0.0;                              ///< largest force met on the way
  double capacityAt_mm = 0.0;                           ///< travel at which it was met
  bool capacityExceeded = false;                        ///< the force fell beyond it
  double asked_N = 0.0;                                 ///< force asked for; 0 where the travel was
  double asked_mm = 0.0;                                ///< travel asked for; 0 where the force was
  double moved_mm = 0.0;                                ///< along the hoist, from the place given to the first touch
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();    ///< of the bar on the liver
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();  ///< about the bar's centre
  double area_mm2 = 0.0, footprint_mm2 = 0.0;  ///< of the surface that touches: as it is, and seen along the hoist
  double pressureMax_kPa = 0.0, penetrationMax_mm = 0.0;
  double smallestJ = 1.0;               ///< least volume ratio of a cell
  std::vector<Eigen::Vector3d> bar_mm;  ///< centre line at travel 0; of a hook in chords
  double barRadius_mm = 0.0;
  Eigen::Vector3d hoist = Eigen::Vector3d::Zero();  ///< unit, LPS
  std::vector<std::array<double, 2>> path;          ///< travel mm, force N
  /// Samples of the smooth surface: place at rest, displacement, area, pressure, one entry each.
  std::vector<Eigen::Vector3d> sample_mm, sample_u_mm;
  std::vector<double> sample_mm2, pressure_kPa;

  bool answered() const { return outcome == mechanics::ContactOutcome::Reached; }
  bool slipped() const { return outcome == mechanics::ContactOutcome::Slips; }
  mechanics::NodalField cut_u_m;  ///< on the nodes of the cut cells that were solved (contactScene), grid axes
};

/// What a ligament does to the liver at the end.
struct LigamentPull {
  LigamentName name = LigamentName::Other;
  double stiffness_N_per_mm = 0.0;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the liver, LPS
};

/// One simulated retraction, back in mm and the patient frame.
struct Result {
  image::DisplacementField u_mm;            ///< at cell centres of the model's grid, 0 outside
  mechanics::NodalField nodal_u_m;          ///< 3 × nodes, the grid's own axes, m
  std::vector<Eigen::Vector3d> probe_u_mm;  ///< one per probe, LPS
  std::vector<std::string> notes;           ///< what the model changed, probes that lie outside
  Diagnostics diagnostics;                  ///< what the model chose by itself
  int dofs = 0;
  int frames = 0;  ///< that were placed; 0 where the model is not mesh-free
  int steps = 0;   ///< time steps; 0 when static
  mechanics::SolveReport solver;
  Eigen::Vector3d load_N = Eigen::Vector3d::Zero();      ///< sum of applied forces, as they are at the end, LPS
  Eigen::Vector3d reaction_N = Eigen::Vector3d::Zero();  ///< sum of support forces, LPS
  double energy_J = 0.0;
  Kinematics kinematics = Kinematics::Linear;  ///< that were solved
  /// Largest principal strain, absolute: small strain where the kinematics are linear, else Biot's (free of rotation).
  double max_strain = 0.0, p95_strain = 0.0, p99_strain = 0.0;
  double fraction_over_10pct = 0.0;  ///< of the volume
  double max_rotation_deg = 0.0;
  double max_displacement_mm = 0.0;
  /// The verdict on the kinematics used. Linear: strains and rotations are small enough for linear theory.
  /// Corotational: converged, no inverted cell, and p95 strain below 10 % (its strains are small-strain). Hyperelastic:
  /// converged, no inverted cell.
  bool linearTrusted = false;
  std::size_t cellsLeftOut =
      0;  ///< of strain and rotation: cut to less than mechanics::leastCovered by the smooth surface
  std::optional<LinearGap> linearGap;  ///< where judgeByGap found it, or the answer in other kinematics
  Diagnostics doubts;                  ///< what is said against the answer, most serious first
  std::vector<std::string> validity;   ///< the same in words
  bool drawable = true;                ///< false: not converged, inverted cells, displacement larger than the body
  void doubt(DiagnosticCode code, std::vector<std::pair<std::string, DiagnosticValue>> arguments = {}) {
    doubts.add(code, std::move(arguments));
    validity = doubts.texts();
  }
  std::optional<Eigen::Vector3d> retractorPoint_mm;  ///< centre of the contact
  double contactArea_mm2 = 0.0;                      ///< that bears on the liver, seen along the hoist
  std::vector<int> contactNodes;                     ///< of a patch
  std::optional<RigidContact> contact;               ///< of a rigid bar
  std::vector<LigamentPull> ligaments;               ///< in the order of the scene's supports
};

/// Builds the mechanics problem (the one crossing from mm and kPa to SI) and solves it.
/// Corotational and hyperelastic kinematics: static, voxel hexahedra. Tetrahedra: static, linear; dofs are those of the
/// tetrahedra, body forces are consistent with them, all other loads act at the voxel corners.
/// A retractor with rigid contact: static, voxel hexahedra, linear or hyperelastic; kinematics Auto are hyperelastic
/// there. Throws BadInput (no support, no contact, unknown region, a model that does not offer what is asked for),
/// SolverFailed where a condensed column does not converge; else the status is in the result.
Result simulate(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& probes_mm,
                const Progress& progress = {});

/// The answer where every modulus is 1/factor of the one that gave `result`, same load, clamps only: displacement and
/// energy times factor. Saves a solve.
Result scaled(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& probes_mm,
              const Result& result, double factor);

/// Displacement at points in mm (LPS), by the shape functions of the cell that holds the point; points outside the body
/// take the nearest cell within half a cell, else NaN.
std::vector<Eigen::Vector3d> displacementAt(const Model& model, const Result& result,
                                            const std::vector<Eigen::Vector3d>& points_mm);

}  // namespace glisson::retraction
