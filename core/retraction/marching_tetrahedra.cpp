// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/marching_tetrahedra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"

namespace glisson::retraction {
namespace {

using Corner = int;  // of a cube: bit 0 along i, bit 1 along j, bit 2 along k
using Tetrahedron = std::array<Corner, 4>;

/// Six tetrahedra around the diagonal 0-7, all positively oriented in index space. The split is the same in every cube,
/// so that neighbours agree on the diagonals of their common face.
constexpr std::array<Tetrahedron, 6> tetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 5, 1, 7}, {0, 6, 4, 7}}};

Eigen::Vector3i offsetOf(Corner c) {
  return {c & 1, c >> 1 & 1, c >> 2 & 1};
}

class March {
 public:
  March(const image::ScalarVolume& field, double level)
      : field_(field), level_(level), flipped_(field.grid.direction.determinant() < 0.0) {
    const std::size_t perLayer = field.grid.linear(0, 0, 1) * 7;
    for (auto& layer : ids_) layer.assign(perLayer, -1);
  }

  mechanics::TriangleSurface run() {
    const Eigen::Vector3i n = field_.grid.size;
    for (int k = 0; k + 1 < n.z(); ++k) {
      auto& upper = ids_[static_cast<std::size_t>((k + 1) & 1)];
      std::fill(upper.begin(), upper.end(), -1);
      for (int j = 0; j + 1 < n.y(); ++j)
        for (int i = 0; i + 1 < n.x(); ++i) cube(Eigen::Vector3i(i, j, k));
    }
    return std::move(surface_);
  }

 private:
  void cube(const Eigen::Vector3i& at) {
    int insideBits = 0;
    for (Corner c = 0; c < 8; ++c) {
      values_[static_cast<std::size_t>(c)] = valueAt(at + offsetOf(c));
      if (values_[static_cast<std::size_t>(c)] > level_) insideBits |= 1 << c;
    }
    if (insideBits == 0 || insideBits == 255) return;
    at_ = at;
    for (const Tetrahedron& t : tetrahedra) tetrahedron(t, insideBits);
  }

  double valueAt(const Eigen::Vector3i& p) const {
    const bool border = (p.array() == 0).any() || (p.array() == field_.grid.size.array() - 1).any();
    return border ? std::min(level_, 0.0) : static_cast<double>(field_.at(p));
  }

  void tetrahedron(const Tetrahedron& t, int insideBits) {
    std::array<std::size_t, 4> order{};
    int inside = 0;
    for (std::size_t a = 0; a < 4; ++a) inside += insideBits >> t[a] & 1;
    if (inside == 0 || inside == 4) return;
    // The corners that are alone come first; an odd order is made even by its last two.
    const bool insideFirst = inside <= 2;
    std::size_t filled = 0;
    for (const bool first : {true, false})
      for (std::size_t a = 0; a < 4; ++a)
        if (((insideBits >> t[a] & 1) != 0) == (first == insideFirst)) order[filled++] = a;
    int inversions = 0;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) inversions += order[a] > order[b] ? 1 : 0;
    if (inversions % 2 != 0) std::swap(order[2], order[3]);
    const Corner a = t[order[0]], b = t[order[1]], c = t[order[2]], d = t[order[3]];
    if (inside == 2) {
      const int ac = vertex(a, c), ad = vertex(a, d), bd = vertex(b, d), bc = vertex(b, c);
      triangle(ac, ad, bd);
      triangle(ac, bd, bc);
    } else if (inside == 1) {
      triangle(vertex(a, b), vertex(a, c), vertex(a, d));
    } else {
      triangle(vertex(a, b), vertex(a, d), vertex(a, c));
    }
  }

  int vertex(Corner a, Corner b) {
    const Corner low = a & b, direction = a ^ b;  // a path from 0 to 7: one corner's bits hold the other's
    const Corner high = low | direction;
    const Eigen::Vector3i p = at_ + offsetOf(low);
    const std::size_t inLayer = field_.grid.linear(p.x(), p.y(), 0);
    int& id = ids_[static_cast<std::size_t>(p.z() & 1)][inLayer * 7 + static_cast<std::size_t>(direction - 1)];
    if (id >= 0) return id;
    const double f = values_[static_cast<std::size_t>(low)], g = values_[static_cast<std::size_t>(high)];
    const double t = std::clamp((level_ - f) / (g - f), 0.02, 0.98);
    id = static_cast<int>(surface_.vertices.size());
    surface_.vertices.push_back(field_.grid.indexToLps(p.cast<double>() + t * offsetOf(direction).cast<double>()));
    return id;
  }

  void triangle(int a, int b, int c) {
    if (flipped_) std::swap(b, c);
    surface_.triangles.push_back({a, b, c});
  }

  const image::ScalarVolume& field_;
  double level_;
  bool flipped_;
  Eigen::Vector3i at_ = Eigen::Vector3i::Zero();
  std::array<double, 8> values_{};
  std::array<std::vector<int>, 2> ids_;  ///< per layer of edges' lower ends: 7 directions per voxel, −1: none yet
  mechanics::TriangleSurface surface_;
};

}  // namespace

mechanics::TriangleSurface marchingTetrahedra(const image::ScalarVolume& field, double level) {
  return March(field, level).run();
}

mechanics::TriangleSurface largestShell(const mechanics::TriangleSurface& surface) {
  const std::size_t n = surface.vertices.size();
  DisjointSets sets(n);
  for (const auto& t : surface.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<double> volume(n, 0.0);
  const Eigen::Vector3d origin = n > 0 ? surface.vertices.front() : Eigen::Vector3d(Eigen::Vector3d::Zero());
  auto at = [&](int v) -> Eigen::Vector3d { return surface.vertices[static_cast<std::size_t>(v)] - origin; };
  for (const auto& t : surface.triangles)
    volume[static_cast<std::size_t>(sets.find(t[0]))] += at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0;
  const auto largest = static_cast<int>(std::max_element(volume.begin(), volume.end()) - volume.begin());

  mechanics::TriangleSurface result;
  std::vector<int> renamed(n, -1);
  for (std::size_t v = 0; v < n; ++v)
    if (sets.find(static_cast<int>(v)) == largest) {
      renamed[v] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(surface.vertices[v]);
    }
  auto name = [&](int v) { return renamed[static_cast<std::size_t>(v)]; };
  for (const auto& t : surface.triangles)
    if (name(t[0]) >= 0) result.triangles.push_back({name(t[0]), name(t[1]), name(t[2])});
  return result;
}

}  // namespace glisson::retraction
