// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "mechanics/contact/cell_kernel.h"
#include "mechanics/contact/membrane.h"
#include "mechanics/grid_transfer.h"
#include "mechanics/row_lattice.h"

namespace glisson::mechanics {

/// A point of the surface as its cell carries it: trilinear weights of eight nodes. slot: the first of two nodes
/// along x, in the rows (j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1).
struct CarriedPoint {
  std::array<std::uint32_t, 4> slot{};
  std::array<float, 8> weight{};  ///< row r, then x: weight[2 r + i]

  template <class T>
  Eigen::Matrix<T, 3, 1> at(const T* field, std::size_t nodes) const {
    Eigen::Matrix<T, 3, 1> v = Eigen::Matrix<T, 3, 1>::Zero();
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t i = 0; i < 2; ++i) {
        const T w = static_cast<T>(weight[2 * r + i]);
        const T* f = field + slot[r] + i;
        v += w * Eigen::Matrix<T, 3, 1>(f[0], f[nodes], f[2 * nodes]);
      }
    return v;
  }
  template <class T>
  void add(const Eigen::Matrix<T, 3, 1>& v, T* field, std::size_t nodes) const {
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t i = 0; i < 2; ++i) {
        const T w = static_cast<T>(weight[2 * r + i]);
        T* f = field + slot[r] + i;
        f[0] += w * v.x();
        f[nodes] += w * v.y();
        f[2 * nodes] += w * v.z();
      }
  }
};

/// The 3 × 3 stiffness of one surface point, N/m: exact, and its positive part. bar: against the bar, whose travel
/// takes part; else against what does not move.
struct PointStiffness {
  std::uint32_t point = 0;
  bool bar = true;
  Eigen::Matrix3f exact = Eigen::Matrix3f::Zero();
  Eigen::Matrix3f positive = Eigen::Matrix3f::Zero();
};

/// A triangle under a load that follows it, in the exact tangent: each of its points bears the same force, whose
/// negative changes by Σ share_j δx_j.
struct FollowerStiffness {
  std::array<std::uint32_t, 3> point{};
  std::array<Eigen::Matrix3f, 3> share{};  ///< N/m
};

/// Lamé's constants of cells, x fastest, Pa times the filled fraction; 0 = empty.
struct CellModuli {
  Eigen::Vector3i cells = Eigen::Vector3i::Zero();
  Eigen::Vector3d h_m = Eigen::Vector3d::Zero();
  std::vector<double> mu_Pa, lambda_Pa;
};

/// One level of a body under large deformation: its cells, what holds it and its linearisation. Fields are three arrays
/// of nodeSlots() values (RowLattice), and one more value for the travel of the bar.
class SolidLevel {
 public:
  /// A spring at a node slot: a symmetric 3 × 3 matrix.
  struct SlotSpring {
    std::size_t slot = 0;
    std::array<double, 6> k{};  ///< xx xy xz yy yz zz, N/m
  };

  explicit SolidLevel(CellModuli moduli);

  /// The next coarser level, with its fixed degrees of freedom; halved is set.
  SolidLevel coarser();

  std::size_t nodes() const { return lattice->nodeSlots(); }
  std::size_t size() const { return 3 * nodes() + 1; }
  /// Where a point at p (m) lies; the cell must be inside the lattice.
  CarriedPoint carry(const Eigen::Vector3i& cell, const Eigen::Vector3d& p_m) const;

  /// Elastic energy of the cells (J) at u and its gradient (N, overwritten). False where the law is not defined.
  bool forces(SolidLaw law, const double* u, double& energy, double* gradient) const;
  double smallestVolumeRatio(const double* u) const;

  /// Tangent at u: cells, springs, contact. positiveOnly: the level serves as a preconditioner only.
  void linearise(SolidLaw law, const double* u, const std::vector<PointStiffness>& contact, bool travels,
                 const Eigen::Vector3d& hoist);
  /// y = tangent · x, x 0 at fixed degrees of freedom.
  void apply(const float* x, float* y, bool positive) const;
  /// x = Chebyshev smoother of r, from 0 or continued; r becomes the residual if asked for.
  void smooth(bool fromZero, bool keepResidual);
  void raiseLambda(float factor) { lambdaMax_ *= factor; }
  /// Whole positive matrix, dense, for the coarsest level; unknowns without stiffness have a unit diagonal.
  Eigen::MatrixXd dense() const;
  /// block⁻¹ x.
  void applyInverseBlocks(const float* x, float* y) const;

  std::shared_ptr<const RowLattice> lattice;
  CellModuli moduli;
  CellModes modes;
  Halved halved{};
  std::vector<double> mu, lambda;            ///< per cell slot, times volume, N m
  std::vector<std::size_t> fixed;            ///< positions in a field
  std::vector<SlotSpring> springs;           ///< at most one per slot
  std::vector<CarriedPoint> points;          ///< all surface points, as this level's cells carry them
  Membrane membrane;                         ///< the skin on this level's cells, or empty
  std::vector<FollowerStiffness> followers;  ///< of the present linearisation, where this level is the finest
  std::vector<char> there;                   ///< per node slot: a filled cell touches it
  std::vector<float> active;                 ///< 3 × nodes: 1 where a node is there and free, else 0
  std::vector<float> x, r, d, y;             ///< work of a cycle

 private:
  void makeBlocks();
  /// r −= y (not at first), d = keep d + gain blocks⁻¹ r, x += d in one pass.
  void smoothStep(float keep, float gain, bool first, bool fromZero);
  template <class T>
  void applyPoints(const T* x, T* y, bool positive) const;
  void estimateLambda();

  std::vector<float> state_;
  std::vector<float> block_;  ///< six arrays of inverse diagonal blocks
  std::vector<PointStiffness> contact_;
  Eigen::Vector3f hoist_ = Eigen::Vector3f::Zero();
  bool travels_ = false;
  float inverseTravel_ = 0;
  float lambdaMax_ = 0;
  std::vector<float> power_;             ///< eigenvector of the last estimate
  std::vector<double> clampedDiagonal_;  ///< at the fixed degrees of freedom, before they are taken out, N/m
};

}  // namespace glisson::mechanics
