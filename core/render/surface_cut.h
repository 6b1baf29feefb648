// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "render/painter.h"
#include "render/slice_plane.h"

namespace glisson::render {

/// Where a surface crosses the plane of a picture, and which pixels lie inside it.
struct SurfaceCut {
  std::vector<std::array<Point, 2>> lines;  ///< pixels
  std::vector<std::uint8_t> inside;         ///< per pixel, by its centre: 1 within the surface
  std::vector<std::uint8_t> closed;         ///< per row: 0 where the surface does not close, and inside says nothing
};

/// surface: closed and outward oriented; it may overlap itself.
SurfaceCut cutSurface(const SlicePlane& plane, const anatomy::TriangleMesh& surface);

/// Pixels that are not known take the mean of those beside them, from the border of each hole inwards. width: of a row.
void fillFromBeside(std::vector<std::uint8_t> unknown, std::size_t width, std::vector<float>& values);

}  // namespace glisson::render
