// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/detail/stencil.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::inversion {
namespace {

using Complex = std::complex<double>;

template <std::size_t n>
std::pair<Complex, Complex> valueAndSlope(const std::array<double, n>& series, Complex x) {
  Complex value = 0.0, slope = 0.0;
  for (std::size_t m = n; m-- > 0;) {
    slope = slope * x + value;
    value = value * x + series[m];
  }
  return {value, slope};
}

/// Voxels to either side of the middle that a window of this radius holds. Throws BadInput where they are too few.
Eigen::Vector3i reachOf(const Eigen::Vector3d& spacing_mm, double radius_mm, int dimensions) {
  Eigen::Vector3i reach = (radius_mm / spacing_mm.array() + 1e-9).floor().cast<int>();
  if (dimensions == 2) reach.z() = 0;
  for (int a = 0; a < dimensions; ++a)
    if (reach[a] < 1) {
      std::ostringstream why;
      why << "a window of radius " << radius_mm << " mm holds fewer than three voxels along axis "
          << "ijk"[a] << " (spacing " << spacing_mm[a] << " mm); take a larger window"
          << (a == 2 ? ", or invert slice by slice" : "");
      throw BadInput(why.str());
    }
  return reach;
}

/// Monomials of degree 2 and less at x: the constant, the linear ones, squares, mixed ones.
Eigen::VectorXd monomials(const Eigen::Vector3d& x, int dimensions) {
  Eigen::VectorXd row(dimensions == 2 ? 6 : 10);
  if (dimensions == 2)
    row << 1, x.x(), x.y(), x.x() * x.x(), x.y() * x.y(), x.x() * x.y();
  else
    row << 1, x.x(), x.y(), x.z(), x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), x.x() * x.y(), x.x() * x.z(),
        x.y() * x.z();
  return row;
}

}  // namespace

Stencil::Stencil(const Eigen::Vector3d& spacing_mm, double radius_mm, int dimensions)
    : dimensions_(dimensions), radius_mm_(radius_mm) {
  const Eigen::Vector3i reach = reachOf(spacing_mm, radius_mm, dimensions);
  // The weight falls to zero smoothly just outside the window: then it sees all directions alike, whatever the voxels.
  const double edge_mm = radius_mm + 0.5 * spacing_mm.head(dimensions).minCoeff();
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> weights, radii;
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i) {
        const Eigen::Vector3d x = spacing_mm.cwiseProduct(Eigen::Vector3d(i, j, k)) / radius_mm;
        if (x.norm() > 1.0 + 1e-9) continue;
        rows.push_back(monomials(x, dimensions));
        radii.push_back(x.norm());
        weights.push_back(std::pow(1.0 - std::pow(x.norm() * radius_mm / edge_mm, 2), 2));
        taps_.push_back({{i, j, k}, 0.0, Eigen::Vector3d::Zero(), 0.0});
      }
  const Eigen::Index terms2 = rows.front().size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms2, terms2);
  for (std::size_t t = 0; t < rows.size(); ++t) normal += weights[t] * rows[t] * rows[t].transpose();
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  for (std::size_t t = 0; t < rows.size(); ++t) {
    const Eigen::VectorXd c = solver.solve(weights[t] * rows[t]);
    taps_[t].value = c[0];
    taps_[t].gradient.head(dimensions) = c.segment(1, dimensions) / radius_mm;
    taps_[t].laplacian = 2.0 * c.segment(1 + dimensions, dimensions).sum() / (radius_mm * radius_mm);
  }
  expandResponse(radii);
}

void Stencil::expandResponse(const std::vector<double>& radii) {
  // Mean of cos(k n·x) over directions n: J0(kr) in the plane, sin(kr)/(kr) in space; both are power series in k²r².
  double coefficient = 1.0;
  for (std::size_t m = 0; m < terms; ++m) {
    for (std::size_t t = 0; t < taps_.size(); ++t) {
      const double moment = coefficient * std::pow(radii[t], 2.0 * static_cast<double>(m));
      valueSeries_[m] += moment * taps_[t].value;
      laplacianSeries_[m] -= moment * taps_[t].laplacian;
    }
    const double next = static_cast<double>(m) + 1.0;
    coefficient /= dimensions_ == 2 ? -4.0 * next * next : -2.0 * next * (2.0 * next + 1.0);
  }
  laplacianSeries_[0] = 0.0;  // exact for constants; only rounding was left
  // Waves count as resolved while the response still rises at a third of its first slope (k R up to about 2.5).
  const double step = 0.01;
  double last = 0.0;
  for (double x = step; x < 16.0; x += step) {
    const double now = response(x / (radius_mm_ * radius_mm_)).real() * radius_mm_ * radius_mm_;
    if (now - last < step / 3.0) break;
    largest_mm2_ = x / (radius_mm_ * radius_mm_);
    last = now;
  }
}

Complex Stencil::response(Complex q_mm2) const {
  const Complex x = q_mm2 * radius_mm_ * radius_mm_;
  return valueAndSlope(laplacianSeries_, x).first / valueAndSlope(valueSeries_, x).first;
}

std::optional<Complex> Stencil::squaredWavenumber(Complex ratio_mm2) const {
  const double area = radius_mm_ * radius_mm_;
  Complex x = ratio_mm2 * area;
  if (!(std::abs(x) <= largest_mm2_ * area)) return std::nullopt;
  for (int step = 0; step < 30; ++step) {
    const auto [l, dl] = valueAndSlope(laplacianSeries_, x);
    const auto [s, ds] = valueAndSlope(valueSeries_, x);
    const Complex change = (l - ratio_mm2 * s) / (dl - ratio_mm2 * ds);
    x -= change;
    if (!(std::abs(x) < 100.0)) return std::nullopt;
    if (std::abs(change) < 1e-12 * std::abs(x)) break;
  }
  if (!(x.real() > 0.0) || !(std::abs(x) <= largest_mm2_ * area)) return std::nullopt;
  return x / area;
}

}  // namespace glisson::inversion
