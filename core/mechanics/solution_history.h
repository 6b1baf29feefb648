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
  bool empty() const { return images_.empty() && !pending_; }
  /// x: the combination; r = b − A x.
  void start(const std::vector<double>& b, std::vector<double>& x, std::vector<double>& r);
  /// Takes the solution of the last start's system, the start + e, and Ae = A e; both are overwritten. They join the
  /// space with the next start, in the same passes over its vectors.
  void add(std::vector<double>& e, std::vector<double>& Ae);

 private:
  using Vectors = std::vector<std::vector<double>>;

  void compress();
  void remember(bool grows, double length);
  static void turn(Vectors& vectors, const Eigen::MatrixXd& Q);

  Vectors vectors_;                        ///< V
  Vectors images_;                         ///< W = A V, orthonormal
  std::vector<double> e_, Ae_;             ///< solved beyond the last start, and its image
  bool pending_ = false;                   ///< they have not joined the space yet
  Eigen::VectorXd coordinates_;            ///< Wᵀ b of the last start
  std::deque<Eigen::VectorXd> solutions_;  ///< coordinates of the last ones, the latest first
};

}  // namespace glisson::mechanics
