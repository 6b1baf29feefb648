// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/arrangement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/disjoint_sets.h"
#include "roi/detail/slabs.h"
#include "roi/plane.h"

namespace glisson::roi {
namespace {

constexpr double trueRepeat_mm = 0.05;    ///< two even-odd outlines within this are one
constexpr double mostlyAlike = 0.5;       ///< of their union that repeated outlines share
constexpr double sticksOutLess_mm = 0.1;  ///< of its border, on the average, by which an enclosed outline may stick out
constexpr double sticksOutPart = 0.01;    ///< of its area
constexpr double touchesOnly = 0.01;      ///< of the smaller area that two outlines may share and be called apart

struct Shape {
  Eigen::Vector2d low, high;
  double area = 0.0, perimeter = 0.0;
};

Shape shapeOf(const Eigen::Matrix2Xd& ring) {
  Shape s{ring.rowwise().minCoeff(), ring.rowwise().maxCoeff()};
  for (Eigen::Index v = 0; v < ring.cols(); ++v) s.perimeter += (ring.col((v + 1) % ring.cols()) - ring.col(v)).norm();
  detail::forTrapezoids({ring}, [&s](const std::vector<bool>& in, double area) { s.area += in[0] ? area : 0.0; });
  return s;
}

bool apart(const Shape& a, const Shape& b) {
  return (a.low.array() > b.high.array()).any() || (b.low.array() > a.high.array()).any();
}

/// How b, not larger than a, lies to it.
Relation relationOf(const Eigen::Matrix2Xd& ringA, const Shape& a, const Eigen::Matrix2Xd& ringB, const Shape& b,
                    double repeat_mm) {
  if (apart(a, b)) return Relation::Apart;
  double shared = 0.0;
  detail::forTrapezoids({ringA, ringB}, [&shared](const std::vector<bool>& in, double area) {
    if (in[0] && in[1]) shared += area;
  });
  const double differing = a.area + b.area - 2.0 * shared, border = 0.5 * (a.perimeter + b.perimeter);
  if (shared > mostlyAlike * (a.area + b.area - shared) && differing < repeat_mm * border) return Relation::Repeated;
  if (shared <= touchesOnly * b.area) return Relation::Apart;
  const double out = b.area - shared;
  return out <= sticksOutPart * b.area && out <= sticksOutLess_mm * b.perimeter ? Relation::Enclosed
                                                                                : Relation::Crossing;
}

}  // namespace

Arrangement arrangeSets(const std::vector<std::size_t>& order,
                        const std::function<Relation(std::size_t, std::size_t)>& relation) {
  const std::size_t n = order.size();
  Arrangement result;
  result.level.assign(n, 0);
  DisjointSets groups(static_cast<int>(n));
  std::vector<bool> overlaps(n, false);
  for (std::size_t at = 0; at < n; ++at) {
    const std::size_t b = order[at];
    std::vector<int> enclosing;
    std::vector<std::size_t> crossed;
    for (std::size_t before = 0; before < at && result.level[b] != Arrangement::repeats; ++before) {
      const std::size_t a = order[before];
      if (result.level[a] == Arrangement::repeats) continue;
      switch (relation(a, b)) {
        case Relation::Repeated:
          result.level[b] = Arrangement::repeats;
          ++result.repeated;
          break;
        case Relation::Enclosed: enclosing.push_back(groups.find(static_cast<int>(a))); break;
        case Relation::Crossing: crossed.push_back(a); break;
        case Relation::Apart: break;
      }
    }
    if (result.level[b] == Arrangement::repeats) continue;
    std::sort(enclosing.begin(), enclosing.end());
    enclosing.erase(std::unique(enclosing.begin(), enclosing.end()), enclosing.end());
    result.level[b] = static_cast<int>(enclosing.size());
    for (const std::size_t a : crossed) {
      if (result.level[a] != result.level[b]) continue;
      groups.join(static_cast<int>(a), static_cast<int>(b));
      overlaps[a] = overlaps[b] = true;
    }
  }
  result.overlapping = static_cast<std::size_t>(std::count(overlaps.begin(), overlaps.end(), true));
  return result;
}

Arrangement arrange(const std::vector<Eigen::Matrix2Xd>& rings, const std::vector<bool>& flips) {
  const std::size_t n = rings.size();
  Arrangement result;
  if (n > 1) {
    std::vector<Shape> shapes;
    for (const Eigen::Matrix2Xd& ring : rings) shapes.push_back(shapeOf(ring));
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return shapes[a].area > shapes[b].area; });
    result = arrangeSets(order, [&](std::size_t a, std::size_t b) {
      if (flips[a] != flips[b]) return Relation::Apart;
      const Relation r =
          relationOf(rings[a], shapes[a], rings[b], shapes[b], flips[b] ? trueRepeat_mm : repeatedWithin_mm);
      return flips[b] && r != Relation::Repeated ? Relation::Apart : r;
    });
  } else {
    result.level.assign(n, 0);
  }
  for (std::size_t r = 0; r < n; ++r)
    if (flips[r] && result.level[r] != Arrangement::repeats) result.level[r] = Arrangement::parity;
  return result;
}

bool holds(const Arrangement& arrangement, const std::vector<bool>& in) {
  int deepest = -1;
  bool flipped = false;
  for (std::size_t n = 0; n < arrangement.level.size(); ++n) {
    if (!in[n]) continue;
    if (arrangement.level[n] == Arrangement::parity)
      flipped = !flipped;
    else
      deepest = std::max(deepest, arrangement.level[n]);
  }
  return (deepest >= 0 && deepest % 2 == 0) != flipped;
}

ContourStack withoutRepeats(const ContourStack& contours) {
  std::vector<bool> repeated(contours.polygons.size(), false);
  for (const FlatPolygons& flat : flatPlanesOf(contours)) {
    std::vector<Eigen::Matrix2Xd> rings;
    std::vector<bool> flips;
    std::vector<std::size_t> which;
    for (std::size_t m = 0; m < flat.members.size(); ++m) {
      const Polygon& polygon = contours.polygons[flat.members[m]];
      if (polygon.exclude) continue;
      rings.push_back(flat.rings_mm[m]);
      flips.push_back(polygon.combine == Combine::Parity);
      which.push_back(flat.members[m]);
    }
    if (rings.size() < 2) continue;
    const Arrangement arrangement = arrange(rings, flips);
    for (std::size_t n = 0; n < which.size(); ++n) repeated[which[n]] = arrangement.level[n] == Arrangement::repeats;
  }
  ContourStack result = contours;
  result.polygons.clear();
  for (std::size_t p = 0; p < contours.polygons.size(); ++p)
    if (!repeated[p]) result.polygons.push_back(contours.polygons[p]);
  return result;
}

}  // namespace glisson::roi
