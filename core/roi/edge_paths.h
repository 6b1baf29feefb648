// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "image/volume.h"

namespace glisson::roi {

/// Paths over one slice that keep to the edges of what is seen: shortest paths over the pixels (eight neighbours),
/// where a step is cheap where the intensity changes steeply [mortensen1998].
class EdgePaths {
 public:
  /// Throws BadArgument where the image has no slice k.
  EdgePaths(const image::ScalarVolume& image, int k);

  /// Where paths begin: pixel (column, row); the nearest one of the image where it lies outside.
  void startAt(const Eigen::Vector2d& pixel);
  /// From the start to this pixel, both included; 2 × n, columns and rows. Points between the ends lie where the
  /// intensity changes most, between the centres of pixels. What was found on the way is kept for the next call.
  Eigen::Matrix2Xd to(const Eigen::Vector2d& pixel);

 private:
  int indexOf(const Eigen::Vector2d& pixel) const;
  double slopeAt(const Eigen::Vector2d& pixel) const;
  void settleUntil(int target);
  Eigen::Vector2d onTheEdge(int index) const;

  int nx_, ny_;
  std::vector<float> slopeX_, slopeY_, slope_;  ///< of the smoothed intensity, per mm
  std::vector<std::uint16_t> cost_;             ///< of a pixel: 1 on the steepest edges
  Eigen::Vector2d spacing_mm_;
  int start_ = 0;
  std::vector<std::uint32_t> distance_;
  std::vector<std::int32_t> before_;
  std::vector<bool> settled_;
  std::vector<std::vector<int>> buckets_;  ///< pixels by distance, around a ring of as many as the longest step
  std::uint32_t at_ = 0;                   ///< distance that is being settled
  std::size_t waiting_ = 0;
};

}  // namespace glisson::roi
