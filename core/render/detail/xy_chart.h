// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "render/charts.h"

namespace glisson::render::detail {

/// Draws lines and points over two axes, with legend, reference lines and the Pareto front where it is asked for.
/// Throws BadArgument (series of unequal lengths, no point that can be drawn).
void paintXyChart(Painter& paint, const XyChart& chart, const ChartSize& size);

}  // namespace glisson::render::detail
