// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "retraction/rigid_contact.h"

namespace glisson::retraction {

/// As in JSON: "model", "time-steps", "condensed", "corotational".
std::string nameOf(RigidRefusal refusal);
/// What refuses, in words that go after "not offered for".
std::string inWords(RigidRefusal refusal, const Setup& setup);

/// What of a scene refuses large deformation without a bar: its model, time steps, the condensed solver.
std::optional<RigidRefusal> largeDeformationRefusal(const Setup& setup);

/// What to do for an answer in large deformation: the kinematics that the scene offers or, where it refuses them, what
/// to change before. A phrase such as "choose \"kinematics\": \"hyperelastic\"".
std::string wayToLargeDeformation(const Setup& setup);

/// Where the retractor does not say how it touches and is a patch because no rigid bar is offered: what refuses one.
std::optional<RigidRefusal> patchTakenFor(const Setup& setup);

}  // namespace glisson::retraction
