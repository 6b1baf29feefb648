// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image/volume.h"

namespace glisson::image {

/// A displacement known inside a body, continued smoothly around it: harmonic (Laplace) outside, falling to zero at
/// margin_mm from the body's bounding box; unchanged inside. Lets an image be warped without a tear at the organ's
/// border. The result covers the bounding box plus the margin, on the same lattice.
DisplacementField extendHarmonically(const DisplacementField& u_mm, const Mask& inside, double margin_mm);

}  // namespace glisson::image
