// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "image/volume.h"

namespace glisson::render {

/// Affine part of a grid, for loops over many points: index = A p + b.
struct LpsToIndex {
  explicit LpsToIndex(const image::Grid& grid);
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_lps) const { return A * p_lps + b; }
  Eigen::Matrix3d A;
  Eigen::Vector3d b;
};

/// Tri-linear value at a continuous index. The half voxel around the outermost centres belongs to the volume and takes
/// the edge value; beyond it the result is 0, or the edge value again where clampOutside is set.
template <typename T>
T sampleLinear(const image::Volume<T>& volume, Eigen::Vector3d index, bool clampOutside = false) {
  const Eigen::Vector3i& size = volume.grid.size;
  Eigen::Vector3i low;
  Eigen::Vector3f f;
  for (int a = 0; a < 3; ++a) {
    if (!(clampOutside || (index[a] >= -0.5 && index[a] <= size[a] - 0.5))) {
      if constexpr (std::is_arithmetic_v<T>)
        return T{};
      else
        return T::Zero();
    }
    const double clamped = std::min(std::max(index[a], 0.0), static_cast<double>(size[a] - 1));
    low[a] = std::min(static_cast<int>(clamped), std::max(0, size[a] - 2));
    f[a] = static_cast<float>(clamped - low[a]);
  }
  const auto sx = static_cast<std::size_t>(size.x() > 1 ? 1 : 0);
  const auto sy = static_cast<std::size_t>(size.y() > 1 ? size.x() : 0);
  const auto sz = size.z() > 1 ? static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) : 0U;
  const T* v = volume.values.data() + volume.grid.linear(low);
  const auto mix = [](const T& a, const T& b, float t) -> T { return a + (b - a) * t; };
  const T bottom = mix(mix(v[0], v[sx], f.x()), mix(v[sy], v[sy + sx], f.x()), f.y());
  const T top = mix(mix(v[sz], v[sz + sx], f.x()), mix(v[sz + sy], v[sz + sy + sx], f.x()), f.y());
  return mix(bottom, top, f.z());
}

class DeformedCells;

/// Finds the rest position x of the material that is at y: x + u(x) = y.
class InverseMap {
 public:
  /// Where the material was at rest.
  struct Result {
    Eigen::Vector3d x_lps;
    double residual_mm = 0.0;  ///< ‖x + u(x) − y‖
    bool found = false;        ///< by a cell that holds y, or to within a quarter of a millimetre
  };
  /// clampOutside: beyond the field's grid its edge value goes on (otherwise 0). The field must outlive this object.
  InverseMap(const image::DisplacementField& u_mm, bool clampOutside);
  /// Material of the mask (0..1) is found wherever a cell of it lies, and before what the field is beyond it. The mask
  /// must outlive this object.
  InverseMap(const image::DisplacementField& u_mm, bool clampOutside, const image::ScalarVolume& mask);
  ~InverseMap();

  /// Displacement at a rest position, tri-linear, mm.
  Eigen::Vector3d at(const Eigen::Vector3d& x_lps) const;

  /// Fixed point x ← y − u(x) with step halving once it stops contracting; the iterate with the smallest residual is
  /// given. With a mask: where that leads to no material of it, by the cells of the mask as they lie now.
  Result rest(const Eigen::Vector3d& y_lps) const;

 private:
  Result iterate(const Eigen::Vector3d& y_lps) const;
  Result polished(const Eigen::Vector3d& x_lps, const Eigen::Vector3d& y_lps) const;
  const image::DisplacementField& u_;
  LpsToIndex toIndex_;
  bool clampOutside_;
  std::unique_ptr<const DeformedCells> cells_;
};

/// The field carried on beyond the voxels where it is known (mask ≥ ½ and u not exactly zero): each layer of voxels
/// takes the mean of its known neighbours, out to reach_mm. Keeps u continuous across the organ's surface, so that the
/// surface itself can be warped. Values at known voxels are not changed.
image::DisplacementField extended(const image::DisplacementField& u_mm, const image::ScalarVolume& mask,
                                  double reach_mm);

/// Mask as 0..1 floats, for tri-linear sampling of its boundary.
image::ScalarVolume asScalar(const image::Mask& mask);

/// Largest ‖u‖, mm.
double largestDisplacement_mm(const image::DisplacementField& u_mm);

}  // namespace glisson::render
