#pragma once

#include "base/quantity.h"
#include "retraction/setup.h"

namespace glisson::session {

/// What can be set on the Model and Retract pages; everything goes into the scene file. The defaults are those of the
/// scene that comes with a synthetic patient, so that window and command line show the same numbers.
struct Parameters {
  // Model
  double poisson = defaults::poisson;  ///< unitless
  double density_kg_m3 = defaults::liverDensity.kgPerM3();
  retraction::ModelKind model = retraction::ModelKind::FemHex;
  double cell_mm = 0.0;  ///< edge of a cell; 0 = twice the MRI's smaller pixel spacing
  int frames = 200;      ///< mesh-free sites
  bool useMre = true;    ///< else the atlas stiffness throughout
  double atlasShear_kPa = defaults::atlasShear.kPa();
  // Retract
  double retractorDiameter_mm = defaults::retractorDiameter.mm();
  double retractorLength_mm = retraction::Retractor{}.length_mm;
  double retractorSpread_mm = retraction::Retractor{}.spread_mm;  ///< how far tissue wraps round the bar
  bool forceIsWeight = true;
  double force_N = 15.0;            ///< where it is not the liver's weight
  double abdomen_kPa_per_mm = 0.1;  ///< Winkler foundation, posterior and superior surface

  bool operator==(const Parameters&) const = default;
};

}  // namespace glisson::session
