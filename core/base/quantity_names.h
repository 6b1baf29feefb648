// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/enum_names.h"
#include "base/quantity.h"

namespace glisson {

/// As in scenes, records and on the command line.
inline constexpr auto stiffnessQuantityNames =
    enumNames<StiffnessQuantity>({{"shear", StiffnessQuantity::Shear}, {"youngs", StiffnessQuantity::Youngs}});

}  // namespace glisson
