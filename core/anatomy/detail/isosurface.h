// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy/triangle_mesh.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// Surface where field crosses level, oriented away from larger values, after smoothing by a windowed sinc of the given
/// number of iterations (0: none; keeps volume nearly). Closed where all values on the border of the grid lie below
/// level.
TriangleMesh isosurface(const image::ScalarVolume& field, double level, int smoothing);

}  // namespace glisson::anatomy
