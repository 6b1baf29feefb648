// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "render/charts.h"

namespace glisson::render::detail {

void paintTornado(Painter& paint, const Tornado& chart, const ChartSize& size);

}  // namespace glisson::render::detail
