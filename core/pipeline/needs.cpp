// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/needs.h"

#include "retraction/rigid_contact.h"

namespace glisson::pipeline::detail {

Needs::Needs(const Scene& s) {
  patient = s.geometry.kind == GeometrySpec::Kind::Patient;
  mre = s.material.kind == MaterialSpec::Kind::Mre;
  map = s.material.kind == MaterialSpec::Kind::Map;
  pictures = s.outputs.overlay || s.outputs.report;
  report = s.outputs.report;
  sofa = s.outputs.sofa;
  // Vessels are found in the contrast-enhanced image; pictures show them where there is such an image.
  vessels = patient && (s.outputs.vessels || pictures || sofa);
  mriValues = (patient && vessels) || pictures;
  liverSurface = pictures;
  meshfree = s.setup.model.kind == retraction::ModelKind::Meshfree;
  timeSteps = s.setup.analysis.dynamic;
  mass = timeSteps;
  damping = timeSteps && (s.setup.analysis.rayleigh[0] > 0 || s.setup.analysis.rayleigh[1] > 0);
  rigidBar = retraction::rigidBarOf(s.setup).has_value();
  const retraction::Kinematics k = s.setup.kinematics;
  newton = k == retraction::Kinematics::Corotational ||
           (k != retraction::Kinematics::Linear && retraction::inLargeDeformation(s.setup));
  uncertainty = s.uncertainty.has_value() && rigidBar;
  condensed = s.setup.condensed;
  linearBeside = newton && !timeSteps;
  discretisation = !timeSteps;
  compare = s.compare.has_value();
  cellField = pictures || compare || s.outputs.displacementField;
  for (const retraction::LoadSpec& load : s.setup.loads) {
    retractor = retractor || std::holds_alternative<retraction::Retractor>(load);
    const auto* pressure = std::get_if<retraction::Pressure>(&load);
    const auto* traction = std::get_if<retraction::Traction>(&load);
    followingLoads = followingLoads || (pressure && pressure->follows) || (traction && traction->follows);
  }
  for (const retraction::SupportSpec& support : s.setup.supports)
    ligaments = ligaments || support.kind == retraction::SupportSpec::Kind::Ligament;
}

}  // namespace glisson::pipeline::detail
