// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/quantity.h"

namespace glisson::python {

/// "shear" or "youngs". Throws BadInput for any other word.
StiffnessQuantity quantityNamed(const std::string& word);
std::string nameOf(StiffnessQuantity quantity);

/// Throws BadInput that names the argument where value is not in [low, high].
void requireWithin(const char* argument, double value, double low, double high);

/// The same where it is not finite and above zero.
void requirePositive(const char* argument, double value);

}  // namespace glisson::python
