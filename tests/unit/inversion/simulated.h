// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "inversion/invert.h"

namespace glisson::inversion::test {

using Complex = std::complex<double>;
using Field = std::function<Complex(const Eigen::Vector3d& p_lps)>;  ///< rad

inline image::Grid lattice(int nx, int ny, int nz, double dx, double dy, double dz) {
  image::Grid g;
  g.size = {nx, ny, nz};
  g.spacing_mm = {dx, dy, dz};
  g.origin_lps_mm = {-30, 12, 55};
  g.direction = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 0.4, -0.3).normalized()).toRotationMatrix();
  return g;
}

/// k = ω √(ρ/G), 1/mm; damped along the way it goes: Im k < 0.
inline Complex wavenumber(Complex modulus_kPa, double frequency_Hz, double density = 1000.0) {
  const Complex q = density * std::pow(2.0 * std::numbers::pi * frequency_Hz, 2) * 1e-9 / modulus_kPa;
  return std::sqrt(q);
}

/// A plane wave that enters the lattice with the given amplitude; along: in index axes.
inline Field planeWave(const image::Grid& g, Complex modulus_kPa, double frequency_Hz, const Eigen::Vector3d& along,
                       double amplitude_rad = 1.0) {
  const Complex k = wavenumber(modulus_kPa, frequency_Hz);
  const Eigen::Vector3d n = g.direction * along.normalized();
  double first = 1e300;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d c(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    first = std::min(first, n.dot(g.indexToLps(c.cwiseProduct((g.size.array() - 1).matrix().cast<double>()))));
  }
  return [=](const Eigen::Vector3d& p) { return amplitude_rad * std::exp(Complex(0, -1) * k * (n.dot(p) - first)); };
}

inline Eigen::Vector3d inPlane(double angle) {
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// N offsets of a wave on top of a smooth phase that does not move, with noise, wrapped.
inline PhaseOffsets phases(const image::Grid& g, const Field& wave, int offsets, double noise_rad, Random& random,
                           const Eigen::Vector3d& encoding = Eigen::Vector3d::Zero()) {
  PhaseOffsets out;
  out.encoding_lps = encoding;
  out.offsets_rad.assign(static_cast<std::size_t>(offsets), image::ScalarVolume(g));
  std::size_t v = 0;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i, ++v) {
        const Complex u = wave(g.indexToLps({double(i), double(j), double(k)}));
        const double still = 0.002 * (i - 20) * (j - 10) + 0.9 * k;
        for (int t = 0; t < offsets; ++t) {
          const double phase = still + (u * std::polar(1.0, 2.0 * std::numbers::pi * t / offsets)).real() +
                               (noise_rad > 0.0 ? noise_rad * random.normal() : 0.0);
          out.offsets_rad[static_cast<std::size_t>(t)].values[v] =
              static_cast<float>(std::remainder(phase, 2.0 * std::numbers::pi));
        }
      }
  return out;
}

struct Summary {
  double mean = 0.0, sd = 0.0;
  std::size_t n = 0;
};

/// Of finite values, where the confidence is high enough and the mask allows it.
inline Summary summarise(const image::ScalarVolume& values, const image::ScalarVolume& confidence, double least,
                         const image::Mask* mask = nullptr) {
  Summary s;
  double sum = 0.0, squares = 0.0;
  for (std::size_t v = 0; v < values.values.size(); ++v) {
    if (!std::isfinite(values.values[v]) || confidence.values[v] < static_cast<float>(least)) continue;
    if (mask != nullptr && mask->values[v] == 0) continue;
    const auto x = static_cast<double>(values.values[v]);
    ++s.n;
    sum += x;
    squares += x * x;
  }
  const auto n = static_cast<double>(s.n);
  s.mean = sum / n;
  s.sd = std::sqrt(std::max(0.0, squares / n - s.mean * s.mean));
  return s;
}

}  // namespace glisson::inversion::test
