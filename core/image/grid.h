// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

namespace glisson::image {

/// A regular lattice of voxels in the patient frame. An integer index is a voxel centre:
///   p_lps = origin_lps_mm + direction * (spacing_mm ∘ index).
/// direction: columns are unit vectors of the i, j, k axes in LPS; orthogonal; its determinant may be −1 (flipped).
struct Grid {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d spacing_mm = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin_lps_mm = Eigen::Vector3d::Zero();  ///< centre of voxel (0, 0, 0)
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();

  std::size_t voxelCount() const {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z());
  }
  double voxelVolume_mm3() const { return spacing_mm.prod(); }

  /// i varies fastest.
  std::size_t linear(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(i);
  }
  std::size_t linear(const Eigen::Vector3i& ijk) const { return linear(ijk.x(), ijk.y(), ijk.z()); }
  bool contains(const Eigen::Vector3i& ijk) const {
    return (ijk.array() >= 0).all() && (ijk.array() < size.array()).all();
  }

  Eigen::Vector3d indexToLps(const Eigen::Vector3d& index) const {
    return origin_lps_mm + direction * spacing_mm.cwiseProduct(index);
  }
  Eigen::Vector3d lpsToIndex(const Eigen::Vector3d& p_lps) const {
    return (direction.transpose() * (p_lps - origin_lps_mm)).cwiseQuotient(spacing_mm);
  }

  /// Throws BadInput where size, spacing, origin or direction are not usable: size < 1, spacing not finite or ≤ 0,
  /// coordinates beyond 1e6 mm, axes not unit or off orthogonal by more than 1e-4, more than 2^31 voxels.
  void check() const;

  /// Same size, and every corner voxel centre within tolerance_mm of the other's.
  bool sameGeometry(const Grid& other, double tolerance_mm = 1e-3) const;
};

}  // namespace glisson::image
