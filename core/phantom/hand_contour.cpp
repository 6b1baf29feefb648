// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/hand_contour.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "phantom/detail/shape.h"

namespace glisson::phantom {
namespace {

using Point2 = Eigen::Vector2d;  // continuous column, row index
using Loop = std::vector<Point2>;

// Zero level of one slice as closed loops (marching squares). Crossings sit on lattice edges, so an edge is a key: two
// per lattice point (0: towards the next column, 1: towards the next row). The slice's rim must be outside.
class ZeroLevel {
 public:
  ZeroLevel(const image::ScalarVolume& f, int k) : f_(f), k_(k), nx_(f.grid.size.x()), ny_(f.grid.size.y()) {
    for (int j = 0; j + 1 < ny_; ++j)
      for (int i = 0; i + 1 < nx_; ++i) addCell(i, j);
  }
  // Takes the edges up.
  std::vector<Loop> loops();

 private:
  double value(int i, int j) const { return static_cast<double>(f_.at(i, j, k_)); }
  long key(int i, int j, int towardsRow) const { return (static_cast<long>(j) * nx_ + i) * 2 + towardsRow; }
  Point2 crossing(long edge) const;
  // The edges that the level crosses in the cell of which (i, j) is the first corner.
  void addCell(int i, int j);

  const image::ScalarVolume& f_;
  int k_, nx_, ny_;
  std::map<long, long> next_;  // from edge to edge, inside on the left
};

Point2 ZeroLevel::crossing(long edge) const {
  const int towardsRow = static_cast<int>(edge % 2);
  const int i = static_cast<int>((edge / 2) % nx_);
  const int j = static_cast<int>((edge / 2) / nx_);
  const double a = value(i, j);
  const double b = towardsRow ? value(i, j + 1) : value(i + 1, j);
  const double t = a / (a - b);
  return towardsRow ? Point2(i, j + t) : Point2(i + t, j);
}

void ZeroLevel::addCell(int i, int j) {
  const int shape = (value(i, j) < 0 ? 1 : 0) | (value(i + 1, j) < 0 ? 2 : 0) | (value(i + 1, j + 1) < 0 ? 4 : 0) |
                    (value(i, j + 1) < 0 ? 8 : 0);
  const long top = key(i, j, 0);
  const long bottom = key(i, j + 1, 0);
  const long left = key(i, j, 1);
  const long right = key(i + 1, j, 1);
  switch (shape) {
    case 1: next_[top] = left; break;
    case 2: next_[right] = top; break;
    case 3: next_[right] = left; break;
    case 4: next_[bottom] = right; break;
    case 5:
      next_[top] = left;
      next_[bottom] = right;
      break;
    case 6: next_[bottom] = top; break;
    case 7: next_[bottom] = left; break;
    case 8: next_[left] = bottom; break;
    case 9: next_[top] = bottom; break;
    case 10:
      next_[right] = top;
      next_[left] = bottom;
      break;
    case 11: next_[right] = bottom; break;
    case 12: next_[left] = right; break;
    case 13: next_[top] = right; break;
    case 14: next_[left] = top; break;
    default: break;  // all inside or all outside
  }
}

std::vector<Loop> ZeroLevel::loops() {
  std::vector<Loop> loops;
  while (!next_.empty()) {
    Loop loop;
    auto it = next_.begin();
    while (it != next_.end()) {
      loop.push_back(crossing(it->first));
      const long to = it->second;
      next_.erase(it);
      it = next_.find(to);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

double signedArea(const Loop& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point2& a = loop[i];
    const Point2& b = loop[(i + 1) % loop.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool crosses(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  auto side = [](const Point2& o, const Point2& p, const Point2& q) {
    return (p.x() - o.x()) * (q.y() - o.y()) - (p.y() - o.y()) * (q.x() - o.x());
  };
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

bool simple(const Loop& loop) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (crosses(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n])) return false;
    }
  return true;
}

// Walks along the loop in uneven steps; each vertex is off by a wobble that changes smoothly along the way.
Loop redraw(const Loop& exact, const Point& inPlane_mm, double z_mm, double wobble, double step, std::uint64_t seed) {
  std::vector<double> along(exact.size() + 1, 0.0);
  for (std::size_t i = 0; i < exact.size(); ++i)
    along[i + 1] = along[i] + (exact[(i + 1) % exact.size()] - exact[i]).norm();
  Random random = derived(seed, 41 + static_cast<std::uint64_t>(std::llround(z_mm * 1000.0)));
  Loop drawn;
  double s = random.uniform(0.0, step);
  std::size_t i = 0;
  while (s < along.back()) {
    while (along[i + 1] < s) ++i;
    const double t = (s - along[i]) / std::max(along[i + 1] - along[i], 1e-12);
    const Point2 p = (1.0 - t) * exact[i] + t * exact[(i + 1) % exact.size()];
    const Point q(p.x() * inPlane_mm.x(), p.y() * inPlane_mm.y(), 3.0 * z_mm);
    Point2 off(noise(q, 26.0, seed + 51), noise(q, 26.0, seed + 52));
    off += 0.25 * Point2(random.uniform(-1, 1), random.uniform(-1, 1));
    off *= wobble;
    if (off.norm() > 0.99) off *= 0.99 / off.norm();
    drawn.push_back(p + off);
    s += step * random.uniform(0.45, 1.7);
  }
  return drawn;
}

}  // namespace

roi::ContourStack drawByHand(const image::ScalarVolume& distance_mm, std::uint64_t seed) {
  const image::Grid& grid = distance_mm.grid;
  roi::ContourStack stack;
  for (int k = 0; k < grid.size.z(); ++k)
    for (const Loop& exact : ZeroLevel(distance_mm, k).loops()) {
      const double pixel_mm2 = grid.spacing_mm.x() * grid.spacing_mm.y();
      const double z_mm = grid.spacing_mm.z() * k;
      if (std::abs(signedArea(exact)) * pixel_mm2 < 60.0) continue;
      Loop drawn;
      double wobble = 0.85;
      double step = 3.2;  // pixels
      for (int attempt = 0; attempt < 8; ++attempt, wobble *= 0.5, step *= 0.75) {
        drawn = redraw(exact, grid.spacing_mm, z_mm, wobble, step, seed);
        if (drawn.size() >= 6 && simple(drawn)) break;
      }
      if (drawn.size() < 6 || !simple(drawn)) drawn = exact;
      roi::Polygon polygon;
      polygon.points_lps_mm.resize(3, static_cast<Eigen::Index>(drawn.size()));
      for (std::size_t i = 0; i < drawn.size(); ++i)
        polygon.points_lps_mm.col(static_cast<Eigen::Index>(i)) =
            grid.indexToLps({drawn[i].x(), drawn[i].y(), static_cast<double>(k)});
      stack.polygons.push_back(std::move(polygon));
    }
  return stack;
}

}  // namespace glisson::phantom
