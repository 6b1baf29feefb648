// SPDX-License-Identifier: GPL-3.0-or-later

// What tests of the outline tools ask of their bench.
#pragma once

#include <cmath>

#include "tool_bench.h"
#include "tools/outline.h"

namespace glisson::test {

inline tools::Outline flat(const ToolBench& b, const Eigen::Matrix3Xd& points) {
  tools::Outline out(2, points.cols());
  for (Eigen::Index v = 0; v < points.cols(); ++v) out.col(v) = b.plane.toPlane_mm(points.col(v));
  return out;
}

inline double area_mm2(const ToolBench& b, std::size_t polygon) {
  return std::abs(tools::signedArea(flat(b, b.contours.polygons.at(polygon).points_lps_mm)));
}

inline void mode(ToolBench& b, tools::ToolMode m) {
  b.apply(b.tool.setMode(m, b.plane));
}

}  // namespace glisson::test
