// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "retraction/rigid_contact.h"
#include "session/parameters.h"

namespace glisson::session {

/// The mechanics that a scene with these parameters has: supports, retractor, model, solver.
retraction::Setup setupOf(const Parameters& parameters);

/// Why no rigid bar is offered with these parameters; nothing where it is.
std::optional<retraction::RigidRefusal> rigidRefusal(const Parameters& parameters);

/// The parameters as the scene takes them. Where no rigid bar is offered the contact is a patch; a patch is straight,
/// has a force (the liver's weight in place of a travel), and no capsule.
Parameters offered(Parameters parameters);

}  // namespace glisson::session
