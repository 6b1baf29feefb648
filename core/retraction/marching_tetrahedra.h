// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "image/volume.h"
#include "mechanics/contact/triangle_surface.h"

namespace glisson::retraction {

/// Surface of { field > level }, linear on six tetrahedra per cube of neighbouring voxel centres: closed, outward
/// oriented, each vertex shared by all its triangles, in mm (LPS). Vertices keep 2 % of an edge's length away from its
/// ends, so that no triangle degenerates. The border of the volume counts as outside.
mechanics::TriangleSurface marchingTetrahedra(const image::ScalarVolume& field, double level);

/// The part of a closed surface that hangs together and encloses the largest volume; unused vertices are dropped.
mechanics::TriangleSurface largestShell(const mechanics::TriangleSurface& surface);

}  // namespace glisson::retraction
