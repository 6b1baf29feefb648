#include "render/sampling.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "render/deformed_cells.h"

namespace glisson::render {
namespace {

constexpr double tolerance_mm = 1e-4;
constexpr double believed_mm = 0.25;  ///< of a residual
constexpr double exact_mm = 0.01;     ///< of a residual: nothing better is looked for

}  // namespace

LpsToIndex::LpsToIndex(const image::Grid& grid)
    : A(grid.spacing_mm.cwiseInverse().asDiagonal() * grid.direction.transpose()), b(-A * grid.origin_lps_mm) {}

InverseMap::InverseMap(const image::DisplacementField& u_mm, bool clampOutside)
    : u_(u_mm), toIndex_(u_mm.grid), clampOutside_(clampOutside) {}

Eigen::Vector3d InverseMap::at(const Eigen::Vector3d& x_lps) const {
  return sampleLinear(u_, toIndex_(x_lps), clampOutside_).cast<double>();
}

InverseMap::InverseMap(const image::DisplacementField& u_mm, bool clampOutside, const image::ScalarVolume& mask)
    : u_(u_mm),
      toIndex_(u_mm.grid),
      clampOutside_(clampOutside),
      cells_(std::make_unique<const DeformedCells>(u_mm, mask)) {}

InverseMap::~InverseMap() = default;

InverseMap::Result InverseMap::rest(const Eigen::Vector3d& y_lps) const {
  Result found = iterate(y_lps);
  found.found = found.residual_mm < believed_mm;
  if (!cells_ || (found.residual_mm < exact_mm && cells_->inside(found.x_lps) >= 0.5F)) return found;
  const std::optional<Eigen::Vector3d> held = cells_->rest(y_lps);
  if (!held || (found.found && cells_->inside(*held) < 0.5F)) return found;
  return polished(*held, y_lps);
}

/// Within a cell the field is tri-linear, not linear as in its tetrahedra: Newton's steps from the one to the other, as
/// far as they stay nearby.
InverseMap::Result InverseMap::polished(const Eigen::Vector3d& x_lps, const Eigen::Vector3d& y_lps) const {
  constexpr int steps = 6;
  const double voxel_mm = u_.grid.spacing_mm.minCoeff(), h_mm = 0.1 * voxel_mm;
  Eigen::Vector3d x = x_lps;
  for (int n = 0; n < steps; ++n) {
    const Eigen::Vector3d r = y_lps - x - at(x);
    if (r.norm() < tolerance_mm) return {x, r.norm(), true};
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d off = h_mm * Eigen::Vector3d::Unit(a);
      jacobian.col(a) += (at(x + off) - at(x - off)) / (2.0 * h_mm);
    }
    const Eigen::Vector3d step = jacobian.partialPivLu().solve(r);
    if (!step.allFinite() || (x + step - x_lps).norm() > voxel_mm) break;
    x += step;
  }
  return {x_lps, (y_lps - x_lps - at(x_lps)).norm(), true};
}

InverseMap::Result InverseMap::iterate(const Eigen::Vector3d& y_lps) const {
  constexpr int iterations = 60;
  Eigen::Vector3d x = y_lps;
  Result best{x, 1e300};
  double step = 1.0;
  for (int n = 0; n < iterations; ++n) {
    const Eigen::Vector3d r = y_lps - x - at(x);
    const double residual = r.norm();
    if (residual < best.residual_mm) {
      best = {x, residual};
      if (residual < tolerance_mm) break;
    } else {
      step = std::max(0.1, 0.5 * step);
    }
    x += step * r;
  }
  return best;
}

image::ScalarVolume asScalar(const image::Mask& mask) {
  image::ScalarVolume out(mask.grid);
  std::transform(mask.values.begin(), mask.values.end(), out.values.begin(),
                 [](std::uint8_t v) { return v != 0 ? 1.0F : 0.0F; });
  return out;
}

double largestDisplacement_mm(const image::DisplacementField& u_mm) {
  float largest2 = 0.0F;
  for (const Eigen::Vector3f& u : u_mm.values) largest2 = std::max(largest2, u.squaredNorm());
  return std::sqrt(static_cast<double>(largest2));
}

image::DisplacementField extended(const image::DisplacementField& u_mm, const image::ScalarVolume& mask,
                                  double reach_mm) {
  const image::Grid& grid = u_mm.grid;
  image::DisplacementField out = u_mm;
  std::vector<std::uint8_t> layer(grid.voxelCount(), 255);  // 0 known, n set in pass n, 255 not reached
  const LpsToIndex toMask(mask.grid);
  parallelChunks(static_cast<std::size_t>(grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          const std::size_t n = grid.linear(i, j, static_cast<int>(k));
          const Eigen::Vector3d p =
              grid.indexToLps({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
          if (!u_mm.values[n].isZero(0.0F) && sampleLinear(mask, toMask(p)) >= 0.5F)
            layer[n] = 0;
          else
            out.values[n].setZero();
        }
  });

  const int passes = std::clamp(static_cast<int>(std::ceil(reach_mm / grid.spacing_mm.minCoeff())), 1, 250);
  const auto inside = [&grid](const Eigen::Vector3i& c) {
    return (c.array() > 0).all() && (c.array() + 1 < grid.size.array()).all();
  };
  std::array<Eigen::Vector3i, 26> steps;
  std::array<std::ptrdiff_t, 26> jumps;
  const auto jumpOf = [&grid](const Eigen::Vector3i& d) {
    return d.x() + std::ptrdiff_t{grid.size.x()} * (d.y() + std::ptrdiff_t{grid.size.y()} * d.z());
  };
  for (std::size_t n = 0, m = 0; n < 27; ++n) {
    const auto i = static_cast<int>(n);
    if (n == 13) continue;
    steps[m] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    jumps[m] = jumpOf(steps[m]);
    ++m;
  }
  /// visit(index, step) for all that lie in the grid; most voxels have all of them, which need no test.
  const auto eachNeighbour = [&](const Eigen::Vector3i& c, auto&& visit) {
    const auto at = static_cast<std::ptrdiff_t>(grid.linear(c));
    const bool all = inside(c);
    for (std::size_t m = 0; m < steps.size(); ++m)
      if (all || grid.contains(Eigen::Vector3i(c + steps[m]))) visit(static_cast<std::size_t>(at + jumps[m]), m);
  };
  std::vector<Eigen::Vector3i> front, reached;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (layer[grid.linear(i, j, k)] == 0) front.emplace_back(i, j, k);
  for (int pass = 1; pass <= passes && !front.empty(); ++pass) {
    std::vector<Eigen::Vector3i> next;
    for (const Eigen::Vector3i& c : front)
      eachNeighbour(c, [&](std::size_t n, std::size_t m) {
        if (layer[n] != 255) return;
        layer[n] = static_cast<std::uint8_t>(pass);
        next.emplace_back(c + steps[m]);
      });
    for (const Eigen::Vector3i& c : next) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int count = 0;
      eachNeighbour(c, [&](std::size_t n, std::size_t) {
        if (layer[n] >= pass) return;
        sum += out.values[n];
        ++count;
      });
      out.values[grid.linear(c)] = sum / static_cast<float>(count);
    }
    reached.insert(reached.end(), next.begin(), next.end());
    front = std::move(next);
  }
  // Fronts from two sides meet in a crease, where x + u(x) could fold: relax it towards a harmonic continuation.
  // What each voxel takes is the same in every sweep: neighbours in the order of the axes, weights 1/spacing².
  struct Relaxed {
    std::size_t voxel;
    std::array<std::int8_t, 6> side;  // which neighbours count
    int count;
    float weight;
  };
  std::array<std::ptrdiff_t, 6> sideJump;
  std::array<Eigen::Vector3i, 6> sideStep;
  std::array<float, 6> sideWeight;
  for (std::size_t n = 0; n < 6; ++n) {
    const auto axis = static_cast<int>(n / 2);
    sideStep[n] = (n % 2 == 0 ? -1 : 1) * Eigen::Vector3i::Unit(axis);
    sideJump[n] = jumpOf(sideStep[n]);
    sideWeight[n] = static_cast<float>(1.0 / (grid.spacing_mm[axis] * grid.spacing_mm[axis]));
  }
  std::vector<Relaxed> relaxed;
  relaxed.reserve(reached.size());
  for (const Eigen::Vector3i& c : reached) {
    Relaxed r{grid.linear(c), {}, 0, 0.0F};
    for (std::size_t n = 0; n < 6; ++n) {
      const Eigen::Vector3i q = c + sideStep[n];
      if (!grid.contains(q) || layer[grid.linear(q)] == 255) continue;
      r.side[static_cast<std::size_t>(r.count++)] = static_cast<std::int8_t>(n);
      r.weight += sideWeight[n];
    }
    if (r.count > 0) relaxed.push_back(r);
  }
  constexpr int sweeps = 12;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const Relaxed& r : relaxed) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int n = 0; n < r.count; ++n) {
        const auto side = static_cast<std::size_t>(r.side[static_cast<std::size_t>(n)]);
        sum += sideWeight[side] *
               out.values[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(r.voxel) + sideJump[side])];
      }
      out.values[r.voxel] = sum / r.weight;
    }
  return out;
}

}  // namespace glisson::render
