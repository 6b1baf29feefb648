#pragma once

#include "base/quantity.h"
#include "retraction/setup.h"
#include "session/placement.h"
#include "session/methods.h"

namespace glisson::session {

/// What can be set on the Model and Retract pages; everything goes into the scene file. The defaults are those of the
/// scene that comes with a synthetic patient but for the retractor: the window's is the linear patch that it moves live,
/// the scene's a rigid bar in large deformation. The case that is saved says so: run by command it gives the window's numbers.
struct Parameters {
  // Model
  double poisson = defaults::poisson;  ///< unitless
  double density_kg_m3 = defaults::liverDensity.kgPerM3();
  Method method = Method::HexIncompatible;
  double cell_mm = 0.0;                                 ///< edge of a cell; 0 = twice the MRI's smaller pixel spacing
  int frames = 200;                                     ///< mesh-free sites
  double tetEdge_mm = retraction::ModelSpec{}.cell_mm;  ///< Delaunay: edges of the tetrahedra
  double tetToolEdge_mm = retraction::ModelSpec{}.toolCell_mm;         ///< and near the retractor
  retraction::Kinematics kinematics = retraction::Kinematics::Linear;  ///< other ones: hexahedra at rest only
  Solver solver = Solver::Auto;
  bool dynamic = false;  ///< time steps to the new rest instead of one solve; hexahedra and mesh-free only
  double step_ms = retraction::AnalysisSpec{}.h_ms;
  double end_s = retraction::AnalysisSpec{}.end_s;
  bool registerRigidly = false;  ///< the elastogram is laid over the MRI first: another breath-hold
  bool useMre = true;            ///< else the atlas stiffness throughout
  double atlasShear_kPa = defaults::atlasShear.kPa();
  // Retract
  double retractorDiameter_mm = defaults::retractorDiameter.mm();
  double retractorLength_mm = retraction::Retractor{}.length_mm;
  double retractorSpread_mm = retraction::Retractor{}.spread_mm;  ///< how far tissue wraps round the bar
  bool forceIsWeight = true;
  double force_N = 15.0;            ///< where it is not the liver's weight
  double abdomen_kPa_per_mm = 0.1;  ///< Winkler foundation, posterior and superior surface
  Placement placement;              ///< of bar, hoist and holds, by hand

  bool operator==(const Parameters&) const = default;
};

}  // namespace glisson::session
