// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

namespace glisson::image {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Which voxels of one axis a cell of that axis overlaps, and by which share of the cell.
using Overlaps = std::vector<std::vector<std::pair<int, double>>>;

Overlaps overlapsOf(const Grid& voxels, const Grid& cells, int axis) {
  const double ratio = cells.spacing_mm[axis] / voxels.spacing_mm[axis];
  const double first = voxels.lpsToIndex(cells.origin_lps_mm)[axis] + 0.5 - 0.5 * ratio;  // voxel edges are integers
  Overlaps all(static_cast<std::size_t>(cells.size[axis]));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double low = first + static_cast<double>(i) * ratio, high = low + ratio;
    const double last = std::min(std::ceil(high), static_cast<double>(voxels.size[axis]));
    for (int v = static_cast<int>(std::clamp(std::floor(low), 0.0, static_cast<double>(voxels.size[axis]))); v < last;
         ++v) {
      const double shared = std::min(high, v + 1.0) - std::max(low, static_cast<double>(v));
      if (shared > 0) all[i].emplace_back(v, shared / ratio);
    }
  }
  return all;
}

/// Coverage in millionths, so that what is equal but for rounding compares equal; 0 beyond the grid.
class Cover {
 public:
  explicit Cover(const ScalarVolume& share) : grid_(share.grid) {
    for (const float s : share.values) {
      millionths_.push_back(std::lround(1e6 * static_cast<double>(s)));
      total_ += static_cast<double>(s);
    }
  }
  long at(const Vector3i& c) const { return grid_.contains(c) ? millionths_[grid_.linear(c)] : 0; }
  double total() const { return total_; }  ///< in cells

  /// 0 to 5: the axis and side towards which most is covered, 6: neither.
  int side(const Vector3i& c) const {
    int best = 6;
    long most = 0;
    for (int a = 0; a < 3; ++a) {
      const long slope = at(c + Vector3i::Unit(a)) - at(c - Vector3i::Unit(a));
      if (std::abs(slope) > most) best = 2 * a + (slope > 0 ? 1 : 0);
      most = std::max(most, std::abs(slope));
    }
    return best;
  }
  bool besideCovered(const Vector3i& c) const {
    for (int a = 0; a < 3; ++a)
      if (at(c + Vector3i::Unit(a)) >= 900000 || at(c - Vector3i::Unit(a)) >= 900000) return true;
    return false;
  }
  long around(const Vector3i& c) const {
    long sum = 0;
    for (int n = 0; n < 27; ++n) sum += at(c + Vector3i(n % 3, n / 3 % 3, n / 9) - Vector3i::Ones());
    return sum;
  }

 private:
  Grid grid_;
  std::vector<long> millionths_;
  double total_ = 0.0;
};

/// Cells that share a face with c hang together without it, by cells that touch it.
bool joinsNothing(const Mask& filled, const Vector3i& c) {
  std::array<bool, 27> there{}, reached{};
  const auto numberOf = [](const Vector3i& step) { return (step.x() + 1) + 3 * (step.y() + 1) + 9 * (step.z() + 1); };
  std::vector<Vector3i> faces, open;
  for (int n = 0; n < 27; ++n) {
    const Vector3i step = Vector3i(n % 3, n / 3 % 3, n / 9) - Vector3i::Ones();
    there[static_cast<std::size_t>(n)] = n != 13 && filled.grid.contains(c + step) && filled.at(c + step);
    if (there[static_cast<std::size_t>(n)] && step.cwiseAbs().sum() == 1) faces.push_back(step);
  }
  if (faces.size() < 2) return true;
  open.push_back(faces.front());
  while (!open.empty()) {
    const Vector3i at = open.back();
    open.pop_back();
    bool& done = reached[static_cast<std::size_t>(numberOf(at))];
    if (std::exchange(done, true)) continue;
    for (int a = 0; a < 3; ++a)
      for (const int d : {-1, 1}) {
        const Vector3i next = at + d * Vector3i::Unit(a);
        if (next.cwiseAbs().maxCoeff() <= 1 && there[static_cast<std::size_t>(numberOf(next))]) open.push_back(next);
      }
  }
  return std::all_of(faces.begin(), faces.end(),
                     [&](const Vector3i& f) { return reached[static_cast<std::size_t>(numberOf(f))]; });
}

/// A cell that may be added or taken away; the smaller the rank, the sooner. Equal ranks go together.
struct Candidate {
  std::tuple<long, long, int> rank;
  Vector3i cell;
};

}  // namespace

ScalarVolume coverage(const Mask& mask, const Grid& cells) {
  cells.check();
  if (!cells.direction.isApprox(mask.grid.direction, 1e-6))
    throw BadArgument("coverage: the cells must lie along the axes of the mask");
  const Overlaps x = overlapsOf(mask.grid, cells, 0), y = overlapsOf(mask.grid, cells, 1),
                 z = overlapsOf(mask.grid, cells, 2);
  ScalarVolume share(cells);
  parallelChunks(z.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t j = 0; j < y.size(); ++j)
        for (std::size_t i = 0; i < x.size(); ++i) {
          double sum = 0.0;
          for (const auto& [w, dz] : z[k])
            for (const auto& [v, dy] : y[j])
              for (const auto& [u, dx] : x[i])
                if (mask.at(u, v, w)) sum += dx * dy * dz;
          share.at(static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)) = static_cast<float>(sum);
        }
  });
  return share;
}

Mask resampleKeepingVolume(const Mask& mask, const Grid& cells) {
  constexpr long half = 500000, band = 150000;
  const Cover cover(coverage(mask, cells));
  Mask filled(cells);
  double missing = cover.total();
  const auto forCells = [&](const auto& body) {
    for (int k = 0; k < cells.size.z(); ++k)
      for (int j = 0; j < cells.size.y(); ++j)
        for (int i = 0; i < cells.size.x(); ++i) body(Vector3i(i, j, k));
  };
  forCells([&](const Vector3i& c) {
    const long share = cover.at(c);
    if (share < half || (share == half && cover.side(c) % 2 == 1)) return;
    filled.at(c) = 1;
    missing -= 1.0;
  });

  const bool add = missing > 0;
  std::vector<Candidate> candidates;
  forCells([&](const Vector3i& c) {
    if ((filled.at(c) != 0) == add || std::abs(cover.at(c) - half) > band || !cover.besideCovered(c)) return;
    const long sign = add ? -1 : 1;
    candidates.push_back({{sign * cover.at(c), sign * cover.around(c), cover.side(c)}, c});
  });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
  double wanted = std::abs(missing);
  for (std::size_t i = 0; i < candidates.size();) {
    std::size_t end = i;
    while (end < candidates.size() && candidates[end].rank == candidates[i].rank) ++end;
    if (0.5 * static_cast<double>(end - i) > wanted) break;
    for (; i < end; ++i) {
      const Vector3i& c = candidates[i].cell;
      if (!add && !joinsNothing(filled, c)) continue;
      filled.at(c) = add ? 1 : 0;
      wanted -= 1.0;
    }
  }
  return filled;
}

}  // namespace glisson::image
