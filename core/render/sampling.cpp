// SPDX-License-Identifier: GPL-3.0-or-later
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

}  // namespace glisson::render
