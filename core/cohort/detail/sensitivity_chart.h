// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "render/charts.h"

namespace glisson::cohort::detail {

/// Each assumption a row, each patient a mark at its value: what moves across the line changes the conclusion.
struct SensitivityChart {
  std::string title, axis, caption;
  render::ReferenceLine line;
  std::vector<std::string> patients;  ///< for the legend
  struct Row {
    std::string assumption;
    std::vector<double> values;  ///< one per patient, not finite where there is none
  };
  std::vector<Row> rows;
};

/// Draws it, as render::paint draws the other charts. Throws BadArgument where nothing can be drawn.
void paint(render::Painter& painter, const SensitivityChart& chart, const render::ChartSize& size = {});

}  // namespace glisson::cohort::detail
