#pragma once

#include "base/quantity.h"
#include "retraction/setup.h"

namespace glisson::session {

/// What can be set on the Model and Retract pages; everything goes into the scene file.
struct Parameters {
  // Model
  double poisson = defaults::poisson;  ///< unitless
  double density_kg_m3 = defaults::liverDensity.kgPerM3();
  retraction::ModelKind model = retraction::ModelKind::FemHex;
  double cell_mm = 4.0;  ///< edge of a cell
  int frames = 200;      ///< mesh-free sites
  bool useMre = true;    ///< else the atlas stiffness throughout
  double atlasShear_kPa = defaults::atlasShear.kPa();
  // Retract
  double retractorDiameter_mm = defaults::retractorDiameter.mm();
  double retractorLength_mm = 80.0;
  bool forceIsWeight = true;
  double force_N = 15.0;            ///< where it is not the liver's weight
  double abdomen_kPa_per_mm = 0.2;  ///< Winkler foundation, posterior and superior surface

  bool operator==(const Parameters&) const = default;
};

}  // namespace glisson::session
