// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/region_cut.h"

#include <cmath>

namespace glisson::tools {

namespace {

/// Pixels of the slice that lie in the region; one more row and column than the slice has stay empty.
std::vector<char> pixelsIn(const image::Mask& region, const image::Grid& grid, int k) {
  const int nx = grid.size.x(), ny = grid.size.y();
  std::vector<char> in(static_cast<std::size_t>(nx + 1) * static_cast<std::size_t>(ny + 1), 0);
  const auto indexOf = [&](int i, int j) {
    return region.grid.lpsToIndex(grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k}));
  };
  const Eigen::Vector3d first = indexOf(0, 0), right = indexOf(1, 0) - first, down = indexOf(0, 1) - first;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Eigen::Vector3d at = first + i * right + j * down;
      const Eigen::Vector3i voxel = (at.array() + 0.5 + 1e-6).floor().matrix().cast<int>();
      if (region.grid.contains(voxel) && region.at(voxel) != 0)
        in[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(i)] = 1;
    }
  return in;
}

}  // namespace

std::vector<BorderEdge> cutOf(const image::Mask& region, const image::Grid& grid, int k) {
  const int nx = grid.size.x(), ny = grid.size.y();
  const std::vector<char> pixels = pixelsIn(region, grid, k);
  const auto in = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny &&
           pixels[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(i)] != 0;
  };
  std::vector<BorderEdge> edges;
  // upright: edges between columns; else between rows. line, step: along which it lies, and along which it goes on.
  const auto collect = [&](bool upright) {
    const int lines = upright ? nx : ny, steps = upright ? ny : nx;
    for (int line = 0; line <= lines; ++line) {
      int begun = -1;
      for (int step = 0; step <= steps; ++step) {
        const bool border =
            step < steps && (upright ? in(line, step) != in(line - 1, step) : in(step, line) != in(step, line - 1));
        if (border && begun < 0) begun = step;
        if (border || begun < 0) continue;
        const double at = line - 0.5, from = begun - 0.5, to = step - 0.5;
        edges.push_back(upright ? BorderEdge{{at, from}, {at, to}} : BorderEdge{{from, at}, {to, at}});
        begun = -1;
      }
    }
  };
  collect(true);
  collect(false);
  return edges;
}

}  // namespace glisson::tools
