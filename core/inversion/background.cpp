// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/detail/background.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace glisson::inversion::detail {
namespace {

using Complex = std::complex<double>;
using Values = std::vector<double>;
constexpr double reach = 3.5;   // of the Gaussian, in standard deviations
constexpr double ridge = 1e-6;  // of the weight, where a few voxels determine no slope

/// Gaussian moments of one slice, without cancellation: coordinates in standard deviations about each voxel.
class Plane {
 public:
  Plane(const image::Grid& grid, double sigma_mm) : nx_(grid.size.x()), ny_(grid.size.y()) {
    for (int axis = 0; axis < 2; ++axis) {
      const double sigma = sigma_mm / grid.spacing_mm[axis];
      const int last = static_cast<int>(std::ceil(reach * sigma));
      for (int power = 0; power < 3; ++power)
        for (int d = -last; d <= last; ++d)
          kernel_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(power)].push_back(
              std::pow(d / sigma, power) * std::exp(-0.5 * d * d / (sigma * sigma)));
    }
  }

  std::size_t size() const { return static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_); }

  /// Σ w(x) x^px y^py in(x) about every voxel.
  Values moment(const Values& in, std::size_t px, std::size_t py) const {
    return alongY(alongX(in, kernel_[0][px]), kernel_[1][py]);
  }
  /// Moments 1, x, y.
  std::array<Values, 3> moments(const Values& in) const {
    const Values even = alongX(in, kernel_[0][0]);
    return {alongY(even, kernel_[1][0]), alongY(alongX(in, kernel_[0][1]), kernel_[1][0]), alongY(even, kernel_[1][1])};
  }

 private:
  Values alongX(const Values& in, const Values& kernel) const {
    Values out(in.size(), 0.0);
    const int last = static_cast<int>(kernel.size()) / 2;
    for (int j = 0; j < ny_; ++j) {
      const double* from = &in[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_)];
      double* to = &out[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_)];
      if (std::all_of(from, from + nx_, [](double v) { return v == 0.0; })) continue;
      for (int d = -last; d <= last; ++d) {
        const double w = kernel[static_cast<std::size_t>(d + last)];
        for (int i = std::max(0, -d); i < std::min(nx_, nx_ - d); ++i) to[i] += w * from[i + d];
      }
    }
    return out;
  }
  Values alongY(const Values& in, const Values& kernel) const {
    Values out(in.size(), 0.0);
    const int last = static_cast<int>(kernel.size()) / 2;
    for (int j = 0; j < ny_; ++j)
      for (int d = std::max(-last, -j); d <= std::min(last, ny_ - 1 - j); ++d) {
        const double w = kernel[static_cast<std::size_t>(d + last)];
        const double* from = &in[static_cast<std::size_t>(j + d) * static_cast<std::size_t>(nx_)];
        double* to = &out[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_)];
        for (int i = 0; i < nx_; ++i) to[i] += w * from[i];
      }
    return out;
  }

  int nx_, ny_;
  std::array<std::array<Values, 3>, 2> kernel_;  // axis, power
};

/// Moments 1, x, y of a complex field, voxel by voxel.
using Moments = std::vector<Eigen::Vector3cd>;

Moments complexMoments(const Plane& plane, const std::complex<float>* in) {
  Values real(plane.size()), imaginary(plane.size());
  for (std::size_t v = 0; v < plane.size(); ++v) {
    real[v] = static_cast<double>(in[v].real());
    imaginary[v] = static_cast<double>(in[v].imag());
  }
  const std::array<Values, 3> a = plane.moments(real), b = plane.moments(imaginary);
  Moments out(plane.size());
  for (std::size_t v = 0; v < plane.size(); ++v)
    out[v] = {Complex(a[0][v], b[0][v]), Complex(a[1][v], b[1][v]), Complex(a[2][v], b[2][v])};
  return out;
}

struct Field {
  std::complex<float>* value;
  const std::complex<float>* laplacian;
  double weight;  // in r: 1 for a wave, −1/n for each of n portions of noise
  Moments ofValue, ofLaplacian;
};

class Slice {
 public:
  Slice(std::vector<FittedDirection>& fitted, const Plane& plane, const std::uint8_t* inner, std::size_t first)
      : plane_(plane) {
    for (FittedDirection& d : fitted) {
      waves_.push_back(fields_.size());
      add(d.wave, first, 1.0);
      for (Fitted& n : d.noise) add(n, first, -1.0 / static_cast<double>(d.noise.size()));
    }
    Values inside(plane.size());
    for (std::size_t v = 0; v < plane.size(); ++v) inside[v] = inner[v] != 0 ? 1.0 : 0.0;
    constexpr std::array<std::array<std::size_t, 2>, 6> powers{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
    for (std::size_t p = 0; p < powers.size(); ++p) mask_[p] = plane.moment(inside, powers[p][0], powers[p][1]);
    products();
  }

  /// b of every field at a voxel; false where no voxel is near.
  bool background(std::size_t v, double least_mm2, std::vector<Complex>& b) const {
    if (!(mask_[0][v] > 0.0)) return false;
    Eigen::Matrix3d n;
    n << mask_[0][v], mask_[1][v], mask_[2][v], mask_[1][v], mask_[3][v], mask_[4][v], mask_[2][v], mask_[4][v],
        mask_[5][v];
    n.diagonal().array() += ridge * mask_[0][v];
    const Eigen::LDLT<Eigen::Matrix3d> solver(n);
    Complex across(cross_[0][v], cross_[1][v]);
    double power = power_[v];
    std::vector<std::array<Complex, 2>> level;  // of u and of ∇²u
    for (const Field& f : fields_) {
      const Eigen::Vector3cd u = solve(solver, f.ofValue[v]), l = solve(solver, f.ofLaplacian[v]);
      power -= f.weight * f.ofValue[v].dot(u).real();  // dot() takes the conjugate of its left side
      across -= f.weight * f.ofValue[v].dot(l);
      level.push_back({u[0], l[0]});
    }
    Complex r = power > 0.0 ? -across / power : 0.0;
    if (!(std::abs(r) >= least_mm2)) r = r == 0.0 ? Complex(least_mm2) : r * (least_mm2 / std::abs(r));
    b.clear();
    for (const auto& [u, l] : level) b.push_back(u + l / r);
    return true;
  }

  std::size_t waveOf(std::size_t direction) const { return waves_[direction]; }
  void takeOff(std::size_t v, const std::vector<Complex>& b) {
    for (std::size_t f = 0; f < fields_.size(); ++f) fields_[f].value[v] -= std::complex<float>(b[f]);
  }

 private:
  void add(Fitted& f, std::size_t first, double weight) {
    fields_.push_back({&f.value[first], &f.laplacian[first], weight, complexMoments(plane_, &f.value[first]),
                       complexMoments(plane_, &f.laplacian[first])});
  }
  static Eigen::Vector3cd solve(const Eigen::LDLT<Eigen::Matrix3d>& solver, const Eigen::Vector3cd& right) {
    const Eigen::Vector3d real = solver.solve(right.real()), imaginary = solver.solve(right.imag());
    return real.cast<Complex>() + Complex(0, 1) * imaginary.cast<Complex>();
  }
  void products() {
    Values power(plane_.size()), real(plane_.size()), imaginary(plane_.size());
    for (const Field& f : fields_)
      for (std::size_t v = 0; v < plane_.size(); ++v) {
        const Complex u(f.value[v]), across = std::conj(u) * Complex(f.laplacian[v]);
        power[v] += f.weight * std::norm(u);
        real[v] += f.weight * across.real();
        imaginary[v] += f.weight * across.imag();
      }
    power_ = plane_.moment(power, 0, 0);
    cross_ = {plane_.moment(real, 0, 0), plane_.moment(imaginary, 0, 0)};
  }

  const Plane& plane_;
  std::vector<Field> fields_;
  std::vector<std::size_t> waves_;
  std::array<Values, 6> mask_;
  Values power_;
  std::array<Values, 2> cross_;
};

}  // namespace

std::vector<std::vector<std::complex<float>>> takeBackgroundOff(std::vector<FittedDirection>& fitted,
                                                                const image::Mask& inner, const image::Mask& mask,
                                                                double sigma_mm, double least_mm2,
                                                                const Progress& progress) {
  const Plane plane(mask.grid, sigma_mm);
  std::vector<std::vector<std::complex<float>>> result(fitted.size(),
                                                       std::vector<std::complex<float>>(mask.values.size()));
  parallelChunks(static_cast<std::size_t>(mask.grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      progress.check();
      const std::size_t first = k * plane.size();
      Slice slice(fitted, plane, &inner.values[first], first);
      std::vector<Complex> b;
      for (std::size_t v = 0; v < plane.size(); ++v) {
        if (mask.values[first + v] == 0 || !slice.background(v, least_mm2, b)) continue;
        for (std::size_t d = 0; d < fitted.size(); ++d) result[d][first + v] = std::complex<float>(b[slice.waveOf(d)]);
        if (inner.values[first + v] != 0) slice.takeOff(v, b);
      }
    }
  });
  return result;
}

}  // namespace glisson::inversion::detail
