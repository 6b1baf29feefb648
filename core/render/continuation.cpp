// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "render/sampling.h"

namespace glisson::render {
namespace {

/// A field that is carried on beyond the voxels where it is known: layer by layer, then relaxed.
class Continuation {
 public:
  /// Known are the voxels in the mask whose displacement is not zero; all others begin at zero.
  Continuation(const image::DisplacementField& u_mm, const image::ScalarVolume& mask);

  /// Each new voxel takes the mean of its neighbours in earlier layers.
  void carryOn(int layers);

  /// Fronts from two sides meet in a crease, where x + u(x) could fold: relaxes the new voxels towards a harmonic
  /// continuation.
  void relax(int sweeps);

  image::DisplacementField take() { return std::move(out_); }

 private:
  static constexpr std::uint8_t known = 0, notReached = 255;  ///< else the layer in which a voxel was reached
  using Index = Eigen::Vector3i;

  /// What a voxel takes in every sweep: neighbours in the order of the axes, weights 1/spacing².
  struct Relaxed {
    std::size_t voxel;
    std::array<std::int8_t, 6> side;  ///< which neighbours count
    int count;
    float weight;
  };

  std::ptrdiff_t jumpOf(const Index& d) const {
    return d.x() + std::ptrdiff_t{grid_.size.x()} * (d.y() + std::ptrdiff_t{grid_.size.y()} * d.z());
  }
  /// visit(index, step) for all neighbours that lie in the grid; most voxels have all of them, which need no test.
  template <typename Visit>
  void eachNeighbour(const Index& c, Visit&& visit) const {
    const auto at = static_cast<std::ptrdiff_t>(grid_.linear(c));
    const bool all = (c.array() > 0).all() && (c.array() + 1 < grid_.size.array()).all();
    for (std::size_t m = 0; m < steps_.size(); ++m)
      if (all || grid_.contains(Index(c + steps_[m]))) visit(static_cast<std::size_t>(at + jumps_[m]), m);
  }
  std::vector<Index> knownVoxels() const;
  std::vector<Index> nextLayer(const std::vector<Index>& front, int layer);
  std::vector<Relaxed> relaxedVoxels() const;

  image::DisplacementField out_;
  const image::Grid& grid_;
  std::vector<std::uint8_t> layer_;
  std::array<Index, 26> steps_;
  std::array<std::ptrdiff_t, 26> jumps_;
  std::array<Index, 6> sideSteps_;
  std::array<std::ptrdiff_t, 6> sideJumps_;
  std::array<float, 6> sideWeights_;
  std::vector<Index> reached_;  ///< in the order in which they were
};

Continuation::Continuation(const image::DisplacementField& u_mm, const image::ScalarVolume& mask)
    : out_(u_mm), grid_(u_mm.grid), layer_(grid_.voxelCount(), notReached) {
  const LpsToIndex toMask(mask.grid);
  parallelChunks(static_cast<std::size_t>(grid_.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (int j = 0; j < grid_.size.y(); ++j)
        for (int i = 0; i < grid_.size.x(); ++i) {
          const std::size_t n = grid_.linear(i, j, static_cast<int>(k));
          const Eigen::Vector3d p =
              grid_.indexToLps({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
          if (!u_mm.values[n].isZero(0.0F) && sampleLinear(mask, toMask(p)) >= 0.5F)
            layer_[n] = known;
          else
            out_.values[n].setZero();
        }
  });
  for (std::size_t n = 0, m = 0; n < 27; ++n) {
    const auto i = static_cast<int>(n);
    if (n == 13) continue;
    steps_[m] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    jumps_[m] = jumpOf(steps_[m]);
    ++m;
  }
  for (std::size_t n = 0; n < 6; ++n) {
    const auto axis = static_cast<int>(n / 2);
    sideSteps_[n] = (n % 2 == 0 ? -1 : 1) * Index::Unit(axis);
    sideJumps_[n] = jumpOf(sideSteps_[n]);
    sideWeights_[n] = static_cast<float>(1.0 / (grid_.spacing_mm[axis] * grid_.spacing_mm[axis]));
  }
}

std::vector<Continuation::Index> Continuation::knownVoxels() const {
  std::vector<Index> voxels;
  for (int k = 0; k < grid_.size.z(); ++k)
    for (int j = 0; j < grid_.size.y(); ++j)
      for (int i = 0; i < grid_.size.x(); ++i)
        if (layer_[grid_.linear(i, j, k)] == known) voxels.emplace_back(i, j, k);
  return voxels;
}

std::vector<Continuation::Index> Continuation::nextLayer(const std::vector<Index>& front, int layer) {
  std::vector<Index> next;
  for (const Index& c : front)
    eachNeighbour(c, [&](std::size_t n, std::size_t m) {
      if (layer_[n] != notReached) return;
      layer_[n] = static_cast<std::uint8_t>(layer);
      next.emplace_back(c + steps_[m]);
    });
  for (const Index& c : next) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int count = 0;
    eachNeighbour(c, [&](std::size_t n, std::size_t) {
      if (layer_[n] >= layer) return;
      sum += out_.values[n];
      ++count;
    });
    out_.values[grid_.linear(c)] = sum / static_cast<float>(count);
  }
  return next;
}

void Continuation::carryOn(int layers) {
  std::vector<Index> front = knownVoxels();
  for (int layer = 1; layer <= layers && !front.empty(); ++layer) {
    front = nextLayer(front, layer);
    reached_.insert(reached_.end(), front.begin(), front.end());
  }
}

std::vector<Continuation::Relaxed> Continuation::relaxedVoxels() const {
  std::vector<Relaxed> relaxed;
  relaxed.reserve(reached_.size());
  for (const Index& c : reached_) {
    Relaxed r{grid_.linear(c), {}, 0, 0.0F};
    for (std::size_t n = 0; n < 6; ++n) {
      const Index q = c + sideSteps_[n];
      if (!grid_.contains(q) || layer_[grid_.linear(q)] == notReached) continue;
      r.side[static_cast<std::size_t>(r.count++)] = static_cast<std::int8_t>(n);
      r.weight += sideWeights_[n];
    }
    if (r.count > 0) relaxed.push_back(r);
  }
  return relaxed;
}

void Continuation::relax(int sweeps) {
  const std::vector<Relaxed> relaxed = relaxedVoxels();
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const Relaxed& r : relaxed) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int n = 0; n < r.count; ++n) {
        const auto side = static_cast<std::size_t>(r.side[static_cast<std::size_t>(n)]);
        sum += sideWeights_[side] *
               out_.values[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(r.voxel) + sideJumps_[side])];
      }
      out_.values[r.voxel] = sum / r.weight;
    }
}

}  // namespace

image::DisplacementField extended(const image::DisplacementField& u_mm, const image::ScalarVolume& mask,
                                  double reach_mm) {
  Continuation field(u_mm, mask);
  field.carryOn(std::clamp(static_cast<int>(std::ceil(reach_mm / u_mm.grid.spacing_mm.minCoeff())), 1, 250));
  field.relax(12);
  return field.take();
}

}  // namespace glisson::render
