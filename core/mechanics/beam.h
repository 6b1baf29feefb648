// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glisson::mechanics {

/// A cantilever of length L along x, clamped at x = 0, rectangular section width × height, bending along the height
/// under a distributed load f (N/m, same sign as the deflection). Closed forms, small deflection. SI units.
struct Cantilever {
  double length_m = 0.05;
  double width_m = 0.01;
  double height_m = 0.01;
  double E_Pa = 12e3;
  double poisson = 0.45;

  constexpr double area_m2() const { return width_m * height_m; }
  constexpr double inertia_m4() const {
    return width_m * height_m * height_m * height_m / 12;
  }  ///< second moment of area
  constexpr double shearModulus_Pa() const { return E_Pa / (2 * (1 + poisson)); }
};

/// Euler-Bernoulli: w(x) = f x² (6L² − 4Lx + x²) / (24 E I).
constexpr double eulerBernoulliDeflection_m(const Cantilever& beam, double f_N_m, double x_m) {
  const double L = beam.length_m;
  return f_N_m * x_m * x_m * (6 * L * L - 4 * L * x_m + x_m * x_m) / (24 * beam.E_Pa * beam.inertia_m4());
}

/// Shear coefficient of a rectangular section, κ = 10(1 + ν)/(12 + 11ν) [cowper1966shear].
constexpr double shearCoefficient(double poisson) {
  return 10 * (1 + poisson) / (12 + 11 * poisson);
}

/// Timoshenko: Euler-Bernoulli plus shear, f (Lx − x²/2) / (κ G A).
constexpr double timoshenkoDeflection_m(const Cantilever& beam, double f_N_m, double x_m) {
  const double rigidity = shearCoefficient(beam.poisson) * beam.shearModulus_Pa() * beam.area_m2();
  return eulerBernoulliDeflection_m(beam, f_N_m, x_m) + f_N_m * (beam.length_m * x_m - x_m * x_m / 2) / rigidity;
}

/// Distributed load whose Euler-Bernoulli tip deflection f L⁴ / (8 E I) is the one given, N/m.
constexpr double loadForTip_N_m(const Cantilever& beam, double tip_m) {
  const double L = beam.length_m;
  return 8 * beam.E_Pa * beam.inertia_m4() * tip_m / (L * L * L * L);
}

}  // namespace glisson::mechanics
