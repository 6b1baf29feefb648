// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/trace.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/error.h"
#include "image/morphology.h"
#include "roi/plane.h"
#include "roi/polygon.h"

// Marching squares on the voxel centres: each cell of four centres adds a step between the mid-points of its sides that
// separate inside from outside. Inside lies to the left of a step, so the steps chain into closed rings.
namespace glisson::roi {
namespace {

using Point = HalfPoint;

class SliceTracer {
 public:
  SliceTracer(const image::Mask& mask, int k) : mask_(mask), k_(k) {
    for (int j = -1; j < mask.grid.size.y(); ++j)
      for (int i = -1; i < mask.grid.size.x(); ++i) addCell(i, j);
  }

  std::vector<std::vector<Point>> rings() {
    std::vector<std::vector<Point>> result;
    while (!next_.empty()) {
      std::vector<Point> ring;
      for (auto step = next_.begin(); step != next_.end(); step = next_.find(ring.back())) {
        const Point to = step->second;
        next_.erase(step);
        ring.push_back(to);
      }
      result.push_back(std::move(ring));
    }
    return result;
  }

 private:
  bool inside(int i, int j) const {
    return i >= 0 && j >= 0 && i < mask_.grid.size.x() && j < mask_.grid.size.y() && mask_.at(i, j, k_) != 0;
  }

  /// Walks round the cell counter-clockwise (column to the right, row up). A side that leaves the inside is the end of
  /// a step, a side that enters it the start; each end joins the start before it, which cuts off the inside corners one
  /// by one and keeps pixels apart that touch at a corner only.
  void addCell(int i, int j) {
    const std::array<Point, 4> corner = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
    std::array<bool, 4> in{};
    for (std::size_t c = 0; c < 4; ++c) in[c] = inside(corner[c][0], corner[c][1]);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(in[c] && !in[(c + 1) % 4])) continue;  // leaves the inside between corner c and c + 1
      std::size_t enter = c;
      while (in[enter]) enter = (enter + 3) % 4;  // last corner outside before c
      next_[middle(corner[c], corner[(c + 1) % 4])] = middle(corner[enter], corner[(enter + 1) % 4]);
    }
  }

  static Point middle(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1]}; }

  const image::Mask& mask_;
  int k_;
  std::map<Point, Point> next_;
};

std::vector<Point> withoutStraightRuns(const std::vector<Point>& ring) {
  std::vector<Point> kept;
  const std::size_t n = ring.size();
  for (std::size_t v = 0; v < n; ++v) {
    const Point &a = ring[(v + n - 1) % n], &b = ring[v], &c = ring[(v + 1) % n];
    if ((b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])) kept.push_back(b);
  }
  return kept;
}

/// Polygons of slice k, from the first given: rings as thin as a pencil line would be taken for one outline drawn
/// twice, so that they flip what they enclose where the slice would not come out as it was.
void keepExact(ContourStack& contours, std::size_t first, const image::Mask& mask, int k) {
  if (contours.polygons.size() < first + 2) return;
  std::vector<std::size_t> here(contours.polygons.size() - first);
  std::iota(here.begin(), here.end(), first);
  image::Grid slice = mask.grid;
  slice.size.z() = 1;
  image::Mask filled(slice);
  fillSlice(filled, 0, contours, here);
  const auto begin = mask.values.begin() + static_cast<std::ptrdiff_t>(mask.grid.linear(0, 0, k));
  const bool same = std::equal(filled.values.begin(), filled.values.end(), begin,
                               [](auto a, auto b) { return (a != 0) == (b != 0); });
  for (const std::size_t p : here)
    if (!same) contours.polygons[p].combine = Combine::Parity;
}

}  // namespace

std::vector<std::vector<HalfPoint>> ringsOf(const image::Mask& mask, int k) {
  return SliceTracer(mask, k).rings();
}

ContourStack contoursOf(const image::Mask& mask) {
  if (image::count(mask) == 0) throw BadInput("the mask is empty (no voxel inside): there is no outline to trace");
  ContourStack result;
  for (int k = 0; k < mask.grid.size.z(); ++k) {
    const std::size_t first = result.polygons.size();
    for (const std::vector<Point>& all : ringsOf(mask, k)) {
      const std::vector<Point> ring = withoutStraightRuns(all);
      Polygon polygon;
      polygon.points_lps_mm.resize(3, static_cast<Eigen::Index>(ring.size()));
      for (std::size_t v = 0; v < ring.size(); ++v)
        polygon.points_lps_mm.col(static_cast<Eigen::Index>(v)) =
            mask.grid.indexToLps({0.5 * ring[v][0], 0.5 * ring[v][1], static_cast<double>(k)});
      result.polygons.push_back(std::move(polygon));
    }
    keepExact(result, first, mask, k);
  }
  return result;
}

}  // namespace glisson::roi
