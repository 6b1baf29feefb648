// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/offered.h"

namespace glisson::retraction {

std::string nameOf(RigidRefusal refusal) {
  switch (refusal) {
    case RigidRefusal::Model: return "model";
    case RigidRefusal::TimeSteps: return "time-steps";
    case RigidRefusal::Condensed: return "condensed";
    case RigidRefusal::Corotational: break;
  }
  return "corotational";
}

std::string inWords(RigidRefusal refusal, const Setup& setup) {
  switch (refusal) {
    case RigidRefusal::Model:
      return setup.model.kind == ModelKind::FemTet ? "tetrahedra (model \"fem-tet\")" : "the model \"meshfree\"";
    case RigidRefusal::TimeSteps: return "the dynamic analysis";
    case RigidRefusal::Condensed: return "the solver \"condensed\"";
    case RigidRefusal::Corotational: break;
  }
  return "corotational kinematics";
}

std::optional<RigidRefusal> largeDeformationRefusal(const Setup& setup) {
  const std::optional<RigidRefusal> refusal = rigidRefusal(setup);
  return refusal == RigidRefusal::Corotational ? std::nullopt : refusal;
}

std::string wayToLargeDeformation(const Setup& setup) {
  const std::optional<RigidRefusal> refusal = largeDeformationRefusal(setup);
  if (!refusal)
    return rigidBarOf(setup) ? "choose \"kinematics\": \"hyperelastic\""
                             : "choose \"kinematics\": \"corotational\" or \"hyperelastic\"";
  const std::string then = ", which offers large deformation (\"kinematics\": \"hyperelastic\")";
  switch (*refusal) {
    case RigidRefusal::Model: return "take the model \"fem-hex\"" + then;
    case RigidRefusal::TimeSteps: return "take the static analysis" + then;
    default: return "take the solver \"auto\"" + then;
  }
}

std::optional<RigidRefusal> patchTakenFor(const Setup& setup) {
  for (const LoadSpec& load : setup.loads)
    if (const auto* bar = std::get_if<Retractor>(&load)) return bar->contact ? std::nullopt : rigidRefusal(setup);
  return {};
}

}  // namespace glisson::retraction
