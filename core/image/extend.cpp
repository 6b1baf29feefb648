// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/extend.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/wide_registers.h"

namespace glisson::image {
namespace {

/// What one row of one colour takes from its neighbours, which are all of the other colour: three floats a voxel.
struct RowTask {
  float* own = nullptr;
  const std::uint32_t* keep = nullptr;  ///< 0 where the value is looked for
  const float *left = nullptr, *right = nullptr, *before = nullptr, *after = nullptr, *below = nullptr,
              *above = nullptr;
  std::size_t count = 0;
};

struct Weights {
  float x = 0.0F, y = 0.0F, z = 0.0F, omega = 1.0F;
};

GLISSON_WIDE void relaxRow(const RowTask& t, const Weights& weights) {
  float* own = t.own;
  const std::uint32_t* keep = t.keep;
  const float *left = t.left, *right = t.right, *before = t.before, *after = t.after, *below = t.below,
              *above = t.above;
  const float wx = weights.x, wy = weights.y, wz = weights.z, omega = weights.omega;
#pragma GCC ivdep
  for (std::size_t f = 0; f < t.count; ++f) {
    const float mean = wx * (left[f] + right[f]) + wy * (before[f] + after[f]) + wz * (below[f] + above[f]),
                value = own[f];
    const float next = value + omega * (mean - value);
    own[f] = keep[f] != 0 ? value : next;
  }
}

/// Successive over-relaxation, red-black by planes of i + j + k so that threads do not change bits; the outermost layer
/// stays zero. The two colours lie apart, so that a row's voxels of one colour follow each other: voxel i is number i/2
/// of its colour (the parity of i + j + k) in its row.
class RedBlack {
 public:
  explicit RedBlack(const Eigen::Vector3i& size)
      : size_(size),
        row_(3 * static_cast<std::size_t>(size.x() / 2 + 1)),
        rows_(static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z())) {
    for (int c = 0; c < 2; ++c) {
      value_[c].assign(row_ * rows_, 0.0F);
      keep_[c].assign(row_ * rows_, 0);
    }
  }

  void fix(int i, int j, int k, const Eigen::Vector3f& value) {
    const int colour = (i + j + k) % 2;
    const std::size_t at = place(i, j, k);
    for (std::size_t c = 0; c < 3; ++c) {
      value_[colour][at + c] = value[static_cast<Eigen::Index>(c)];
      keep_[colour][at + c] = 1;
    }
  }
  Eigen::Vector3f at(int i, int j, int k) const {
    return Eigen::Map<const Eigen::Vector3f>(value_[(i + j + k) % 2].data() + place(i, j, k));
  }

  void sweep(const Weights& weights) {
    for (const int colour : {1, 0})
      parallelChunks(static_cast<std::size_t>(std::max(0, size_.z() - 2)), 4, [&](std::size_t begin, std::size_t end) {
        for (int k = static_cast<int>(begin) + 1; k < static_cast<int>(end) + 1; ++k)
          for (int j = 1; j + 1 < size_.y(); ++j) relax(colour, j, k, weights);
      });
  }

 private:
  std::size_t rowOf(int j, int k) const {
    return row_ * (static_cast<std::size_t>(k) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(j));
  }
  std::size_t place(int i, int j, int k) const { return rowOf(j, k) + 3 * static_cast<std::size_t>(i / 2); }

  void relax(int colour, int j, int k, const Weights& weights) {
    const int first = 1 + (j + k + 1 + colour) % 2;  // voxel of the row with i + j + k of this parity
    const int count = (size_.x() - first) / 2;       // the last voxel is left out
    if (count <= 0) return;
    const std::vector<float>& other = value_[1 - colour];
    const std::size_t at = place(first, j, k);
    RowTask task;
    task.own = value_[colour].data() + at;
    task.keep = keep_[colour].data() + at;
    task.left = other.data() + place(first - 1, j, k);
    task.right = other.data() + place(first + 1, j, k);
    task.before = other.data() + place(first, j - 1, k);
    task.after = other.data() + place(first, j + 1, k);
    task.below = other.data() + place(first, j, k - 1);
    task.above = other.data() + place(first, j, k + 1);
    task.count = 3 * static_cast<std::size_t>(count);
    relaxRow(task, weights);
  }

  Eigen::Vector3i size_;
  std::size_t row_, rows_;
  std::vector<float> value_[2];
  std::vector<std::uint32_t> keep_[2];
};

}  // namespace

DisplacementField extendHarmonically(const DisplacementField& u_mm, const Mask& inside, double margin_mm) {
  if (u_mm.values.size() != inside.values.size())
    throw BadArgument("extendHarmonically: field and mask have different grids");
  const Grid& g = u_mm.grid;
  const Eigen::Vector3i pad =
      (Eigen::Vector3d::Constant(margin_mm).cwiseQuotient(g.spacing_mm)).array().ceil().cast<int>();
  Grid wide = g;
  wide.size = g.size + 2 * pad;
  wide.origin_lps_mm = g.indexToLps(-pad.cast<double>());

  RedBlack field(wide.size);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        if (inside.at(i, j, k)) field.fix(i + pad.x(), j + pad.y(), k + pad.z(), u_mm.at(i, j, k));

  // Weights follow the spacing of each axis.
  const Eigen::Vector3d w = g.spacing_mm.cwiseAbs2().cwiseInverse();
  const int longest = pad.maxCoeff();
  const Weights weights{static_cast<float>(w.x() / (2 * w.sum())), static_cast<float>(w.y() / (2 * w.sum())),
                        static_cast<float>(w.z() / (2 * w.sum())),
                        static_cast<float>(2.0 / (1.0 + std::sin(std::numbers::pi / std::max(4, 2 * longest))))};
  const int sweeps = std::max(20, 4 * longest);
  for (int sweep = 0; sweep < sweeps; ++sweep) field.sweep(weights);

  DisplacementField out(wide, Eigen::Vector3f::Zero());
  std::size_t n = 0;
  for (int k = 0; k < wide.size.z(); ++k)
    for (int j = 0; j < wide.size.y(); ++j)
      for (int i = 0; i < wide.size.x(); ++i, ++n) out.values[n] = field.at(i, j, k);
  return out;
}

}  // namespace glisson::image
