// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <optional>
#include <vector>

namespace glisson::inversion {

/// Weights that give value, gradient and Laplacian at the middle of a window from a quadratic polynomial fitted to the
/// window by weighted least squares (weight (1 − (r/R)²)², a local Savitzky-Golay filter on any spacing). Exact for
/// quadratic fields.
class Stencil {
 public:
  /// What one voxel of the window adds to value and derivatives at its centre.
  struct Tap {
    Eigen::Vector3i offset;
    double value;              ///< 1
    Eigen::Vector3d gradient;  ///< 1/mm, along the index axes
    double laplacian;          ///< 1/mm²
  };

  /// All voxels within radius_mm; dimensions 2 stays in the slice. Throws BadInput where the window holds fewer than
  /// three voxels along an axis.
  Stencil(const Eigen::Vector3d& spacing_mm, double radius_mm, int dimensions);

  const std::vector<Tap>& taps() const { return taps_; }
  int dimensions() const { return dimensions_; }

  /// What the ratio −Laplacian/value comes out as for plane waves of squared wavenumber q = k², 1/mm², averaged over
  /// their direction: f(q) = q for vanishing k, below it otherwise. Analytic, so damped waves have a complex q.
  std::complex<double> response(std::complex<double> q_mm2) const;

  /// The inverse of response(): q with response(q) = ratio. Takes away what the finite window does to a wave. Empty
  /// where the window cannot resolve the wave (response not monotonic any more, or q with negative real part).
  std::optional<std::complex<double>> squaredWavenumber(std::complex<double> ratio_mm2) const;

  /// Largest |q|, 1/mm², that squaredWavenumber() gives.
  double largestResolved_mm2() const { return largest_mm2_; }

 private:
  /// Fills the series and what they resolve; radii: of the taps, in window radii.
  void expandResponse(const std::vector<double>& radii);

  static constexpr std::size_t terms = 20;
  std::vector<Tap> taps_;
  int dimensions_;
  double radius_mm_;
  /// Power series in q R² of the direction-averaged transfer functions.
  std::array<double, terms> valueSeries_{}, laplacianSeries_{};
  double largest_mm2_ = 0.0;
};

}  // namespace glisson::inversion
