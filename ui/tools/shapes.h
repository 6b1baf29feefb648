// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "tools/outline.h"

namespace glisson::tools {

/// Curves that end as polygons. Points are 2 × n, mm in the plane of a slice.

/// The ellipse in the box with these opposite corners, from its right end on; circle: with both axes as long as the
/// longer one, from the first corner on. The polygon has the area of the ellipse and lies within tolerance_mm of it (at
/// least 12 and at most 360 vertices). No points where the box has no area.
Outline ellipse(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool circle, double tolerance_mm);

/// A smooth closed curve through all points in their order, as a polygon that lies within about tolerance_mm of it:
/// centripetal Catmull-Rom, which has no loops or cusps between two points [yuksel2011]. The points are vertices of
/// it. Points that repeat the one before count once; fewer than three points stay as they are.
Outline closedSpline(const Outline& through, double tolerance_mm);

}  // namespace glisson::tools
