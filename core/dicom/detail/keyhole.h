// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "dicom/rtstruct.h"

namespace glisson::dicom {

/// RT Structure Sets know no holes: a contour inside another one of the same plane is joined to it by a channel of no
/// width (keyhole), so that one closed contour encloses the area between. Every vertex is kept and none is moved; the
/// channel is run through in both directions, so that the even-odd rule gives the same pixels. Contours that cross stay
/// as they are. Contours of a hole run against the outer one.
std::vector<StructureContour> withKeyholes(const std::vector<StructureContour>& contours);

}  // namespace glisson::dicom
