// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace glisson::render {

SurfaceCut cutSurface(const SlicePlane& plane, const anatomy::TriangleMesh& surface) {
  SurfaceCut cut;
  const auto width = static_cast<std::size_t>(plane.width), rows = static_cast<std::size_t>(plane.height);
  cut.inside.assign(width * rows, 0);
  cut.closed.assign(rows, 1);
  const Eigen::Vector3d normal = plane.normal();
  const Eigen::Matrix3Xd& p = surface.vertices_lps_mm;
  std::vector<double> height(static_cast<std::size_t>(p.cols()));
  for (std::size_t n = 0; n < height.size(); ++n)
    height[n] = (p.col(static_cast<Eigen::Index>(n)) - plane.corner_lps).dot(normal);

  struct Crossing {
    double x;
    int into;  ///< 1 where the surface is entered towards larger x, else −1
  };
  std::vector<std::vector<Crossing>> crossings(rows);
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    const Eigen::Vector3i corner = surface.triangles.col(t);
    std::array<Point, 2> line;
    std::size_t ends = 0;
    for (int e = 0; e < 3; ++e) {
      // The same arithmetic from either side of an edge, so that neighbours meet in one point.
      const auto [a, b] = std::minmax(corner[e], corner[(e + 1) % 3]);
      const double from = height[static_cast<std::size_t>(a)], to = height[static_cast<std::size_t>(b)];
      if ((from < 0.0) == (to < 0.0)) continue;
      if (ends < 2) line[ends++] = plane.toPixel(p.col(a) + (p.col(b) - p.col(a)) * (from / (from - to)));
    }
    if (ends != 2) continue;
    cut.lines.push_back(line);
    const Eigen::Vector3d out = (p.col(corner[1]) - p.col(corner[0])).cross(p.col(corner[2]) - p.col(corner[0]));
    const int into = out.dot(plane.right) < 0.0 ? 1 : -1;
    const auto [low, high] = std::minmax(line[0].y(), line[1].y());
    const int first = std::max(0, static_cast<int>(std::floor(low - 0.5))),
              last = std::min(plane.height - 1, static_cast<int>(std::ceil(high - 0.5)));
    for (int row = first; row <= last; ++row) {
      const double y = row + 0.5;
      if ((line[0].y() < y) == (line[1].y() < y)) continue;
      const double share = (y - line[0].y()) / (line[1].y() - line[0].y());
      crossings[static_cast<std::size_t>(row)].push_back({line[0].x() + share * (line[1].x() - line[0].x()), into});
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    std::vector<Crossing>& here = crossings[row];
    std::sort(here.begin(), here.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    int winding = 0;
    std::size_t next = 0;
    for (std::size_t column = 0; column < width; ++column) {
      for (; next < here.size() && here[next].x < static_cast<double>(column) + 0.5; ++next) winding += here[next].into;
      cut.inside[row * width + column] = winding > 0 ? 1 : 0;
    }
    for (; next < here.size(); ++next) winding += here[next].into;
    if (winding != 0) cut.closed[row] = 0;
  }
  return cut;
}

void fillFromBeside(std::vector<std::uint8_t> unknown, std::size_t width, std::vector<float>& values) {
  std::vector<std::size_t> holes;
  for (std::size_t n = 0; n < unknown.size(); ++n)
    if (unknown[n]) holes.push_back(n);
  while (!holes.empty()) {
    std::vector<std::size_t> left, done;
    for (const std::size_t n : holes) {
      float sum = 0.0F;
      int count = 0;
      const auto add = [&](bool there, std::size_t beside) {
        if (!there || unknown[beside]) return;
        sum += values[beside];
        ++count;
      };
      add(n % width > 0, n - 1);
      add(n % width + 1 < width, n + 1);
      add(n >= width, n - width);
      add(n + width < values.size(), n + width);
      if (count > 0) values[n] = sum / static_cast<float>(count);
      (count > 0 ? done : left).push_back(n);
    }
    if (done.empty()) return;
    for (const std::size_t n : done) unknown[n] = 0;
    holes = std::move(left);
  }
}

}  // namespace glisson::render
