// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/quantity.h"
#include "retraction/setup.h"
#include "session/methods.h"
#include "session/placement.h"

namespace glisson::session {

/// What can be set on the Model and Retract pages; everything goes into the scene file. The defaults are those of the
/// scene that comes with a synthetic patient: a rigid bar in large deformation, with Glisson's capsule. The case that
/// is saved says so: run by command it gives the window's numbers.
struct Parameters {
  // Model
  double poisson = defaults::poisson;  ///< unitless
  double density_kg_m3 = defaults::liverDensity.kgPerM3();
  Method method = Method::HexIncompatible;
  double cell_mm = 0.0;                                 ///< edge of a cell; 0 = twice the MRI's smaller pixel spacing
  int frames = 200;                                     ///< mesh-free sites
  double tetEdge_mm = retraction::ModelSpec{}.cell_mm;  ///< Delaunay: edges of the tetrahedra
  double tetToolEdge_mm = retraction::ModelSpec{}.toolCell_mm;       ///< and near the retractor
  retraction::Kinematics kinematics = retraction::Kinematics::Auto;  ///< large deformation: hexahedra at rest only
  Solver solver = Solver::Auto;
  bool dynamic = false;  ///< time steps to the new rest instead of one solve; hexahedra and mesh-free only
  double step_ms = retraction::AnalysisSpec{}.h_ms;
  double end_s = retraction::AnalysisSpec{}.end_s;
  bool registerRigidly = false;  ///< the elastogram is laid over the MRI first: another breath-hold
  bool howSure = false;          ///< intervals and what drives them, under a rigid bar
  bool useMre = true;            ///< else the atlas stiffness throughout
  double atlasShear_kPa = defaults::atlasShear.kPa();
  // Retract
  double retractorDiameter_mm = defaults::retractorDiameter.mm();
  double retractorLength_mm = retraction::Retractor{}.length_mm;
  /// A rigid bar where model, analysis, solver and kinematics offer it; else, and where it is wanted, a spread patch.
  retraction::ContactKind contact = retraction::ContactKind::Rigid;
  retraction::BarShape shape = retraction::BarShape::Straight;    ///< of a rigid bar
  double retractorSpread_mm = retraction::Retractor{}.spread_mm;  ///< of a patch: how far tissue wraps round the bar
  Drive drive = Drive::LiverWeight;
  double force_N = 15.0;    ///< Drive::Force
  double travel_mm = 40.0;  ///< Drive::Travel, of a rigid bar
  bool capsule = true;      ///< Glisson's capsule, under a rigid bar
  double capsule_N_per_mm = retraction::Capsule{}.tension_N_per_mm;
  double abdomen_kPa_per_mm = 0.1;  ///< Winkler foundation, posterior and superior surface
  Placement placement;              ///< of bar, hoist and holds, by hand

  bool operator==(const Parameters&) const = default;
};

}  // namespace glisson::session
