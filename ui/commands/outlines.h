// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>

#include "roi/contour_stack.h"

namespace glisson::commands {

/// What a reader has said of a slice beside outlines. NoLiver: nothing to outline here. NoWave: outlined or not, its
/// stiffness is not to be measured.
enum class SliceMark { NoLiver, NoWave };

/// Everything a reader makes and undo covers: polygons, their name, and marks of slices.
struct Outlines : roi::ContourStack {
  std::map<int, SliceMark> marks;  ///< by slice (k) of the image that is drawn on
};

}  // namespace glisson::commands
