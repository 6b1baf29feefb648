// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "image/volume.h"
#include "render/sampling.h"

namespace glisson::render {

/// The cells between the points of a displacement field as they lie after the displacement, each in six tetrahedra, and
/// which of them holds a place. Finds the rest position also where iterations for it do not converge: beside a bar,
/// where tissue is stretched by more than its own length or folds.
class DeformedCells {
 public:
  /// The cells that mask (0..1, on any grid) reaches into. The field must outlive this object.
  DeformedCells(const image::DisplacementField& u_mm, const image::ScalarVolume& mask);

  /// Rest position of the material that is at y, by the linear map of the tetrahedron that holds it. Where several do,
  /// one that is not turned inside out, and of these the one deepest in the mask. Empty: none does.
  std::optional<Eigen::Vector3d> rest(const Eigen::Vector3d& y_lps) const;
  /// How much of the mask is at a rest position, 0..1.
  float inside(const Eigen::Vector3d& x_lps) const;

 private:
  void sort();
  Eigen::Vector3i lowestOf(std::uint32_t cell) const;
  std::size_t boxAt(const Eigen::Vector3i& place) const;
  std::array<Eigen::Vector3d, 8> cornersOf(std::uint32_t cell) const;

  const image::DisplacementField& u_;
  const image::ScalarVolume& mask_;
  LpsToIndex toIndex_, toMask_;
  std::vector<std::uint32_t> cells_;  ///< linear index of their lowest corner
  /// Boxes of a voxel's size over where the cells lie now; those that reach into box b are entries_[first_[b]] up to
  /// first_[b + 1].
  Eigen::Vector3i low_ = Eigen::Vector3i::Zero(), boxes_ = Eigen::Vector3i::Zero();
  std::vector<std::uint32_t> first_, entries_;
};

}  // namespace glisson::render
