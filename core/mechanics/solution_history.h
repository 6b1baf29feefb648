// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <vector>

namespace glisson::mechanics {

/// Starts for a sequence of systems A x = b with one matrix, as the steps of a motion are: the combination of the last
/// solutions that leaves the smallest residual, at most ‖b‖ [fischer1998projection]. No extrapolation from them leaves
/// less. Arrays of one length; the same bits with any number of threads.
class SolutionHistory {
 public:
  static constexpr std::size_t kept = 4;     ///< solutions that the space always spans
  static constexpr std::size_t largest = 8;  ///< vectors and their images stored at most

  void clear();
  bool empty() const { return images_.empty(); }
  /// x: the combination; r = b − A x.
  void start(const std::vector<double>& b, std::vector<double>& x, std::vector<double>& r);
  /// Takes the solution of the last start's system: the start + e. e is overwritten; Ae = A e as well.
  void add(std::vector<double>& e, std::vector<double>& Ae);

 private:
  using Vectors = std::vector<std::vector<double>>;

  void compress();
  static void turn(Vectors& vectors, const Eigen::MatrixXd& Q);

  Vectors vectors_;                        ///< V
  Vectors images_;                         ///< W = A V, orthonormal
  Eigen::VectorXd coordinates_;            ///< Wᵀ b of the last start
  std::deque<Eigen::VectorXd> solutions_;  ///< coordinates of the last ones, the latest first
};

}  // namespace glisson::mechanics
