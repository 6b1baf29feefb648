// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "retraction/simulate.h"

namespace glisson::retraction::detail {

/// No equilibrium under the loads, however small their steps.
void tellLoadsNotBorne(const std::string& stiffness, Result& result);

/// The bar did not get to what was asked for, or only behind a limit: says so. False where nothing that fails is to be
/// said.
bool doubtOfBar(const RigidContact& contact, const std::string& stiffness, Result& result);

}  // namespace glisson::retraction::detail
