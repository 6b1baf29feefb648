#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace glisson::inversion::detail {

/// What a shear wave of one wavenumber can look like within a disc of a slice, whatever directions it comes from:
/// u = Σ c_m J_m(kr) e^{imθ}, |m| ≤ orders, the regular solutions of ∇²u + k²u = 0; beside it, where asked for, motion
/// that is affine across the disc (compression, whose waves are metres long, and the body moving as a whole).
/// Columns are analytic in x = k²R², so that damped waves have a complex x, and have no zero at x = 0: J_m is divided by
/// (k/2)^m/m!.
class WaveBasis {
 public:
  using Complex = std::complex<double>;

  /// Voxels of a lattice within radius_mm of the middle; stride > 1 takes every stride-th along both axes. Throws
  /// BadInput where fewer than three lie on a diameter.
  WaveBasis(const Eigen::Vector3d& spacing_mm, double radius_mm, int orders, bool affine, int stride);

  const std::vector<Eigen::Vector2i>& taps() const { return taps_; }
  Eigen::Index columns() const { return affine_ + 1 + 2 * orders_; }
  Eigen::Index affineColumns() const { return affine_; }

  /// taps × columns at a real x ≥ 0.
  Eigen::MatrixXd at(double x) const;
  /// The same at a complex x, with the derivative by x (zero for affine columns).
  void at(Complex x, Eigen::MatrixXcd& value, Eigen::MatrixXcd& slope) const;

 private:
  template <typename Scalar>
  void fill(Scalar x, Eigen::Matrix<Scalar, -1, -1>& value, Eigen::Matrix<Scalar, -1, -1>* slope) const;

  std::vector<Eigen::Vector2i> taps_;
  std::vector<int> ring_;          ///< of each tap: index into radii_
  std::vector<double> radii_;      ///< distinct r/R
  Eigen::MatrixXd angular_;        ///< taps × (1 + 2 orders): 1, cos θ, sin θ, cos 2θ ...
  Eigen::MatrixXd affineValues_;   ///< taps × affine columns
  int orders_ = 0;
  Eigen::Index affine_ = 0;
};

}  // namespace glisson::inversion::detail
