// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "roi/contour_stack.h"

namespace glisson::exchange {

/// Contours as a 3D Slicer markups file (.mrk.json, schema 1.0.3): one closed curve per polygon, control points in LPS
/// mm with all digits of a double. Drafts are left out; regions to leave out are named "exclude". The result reads back
/// with markupsToContours.
std::string contoursToMarkups(const roi::ContourStack& contours);

/// Closed curves of a markups file (LPS or RAS) as accepted polygons. Throws BadInput where the text is no markups file
/// or holds no closed curve of three points.
roi::ContourStack markupsToContours(const std::string& text, const std::string& source = "markups");

}  // namespace glisson::exchange
