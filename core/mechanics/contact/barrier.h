// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace glisson::mechanics {

/// Logarithmic barrier of a gap g: φ = −κ (a − w)² ln(a/w) for a = g + w/2 below w, else 0. Half of the zone of width w
/// lies inside the body, so that the surface in contact is on average where it should be. Below a = 0.15 w its
/// second-order expansion goes on (pressures of soft tissue do not get there), so that steps may end inside and come
/// back; states deeper than `guard_m` are refused.
struct Barrier {
  double kappa_Pa_m = 2e7;
  double width_m = 1e-3;
  double guard_m = 2e-3;

  /// The barrier and its derivatives by the gap.
  struct Value {
    double energy = 0, first = 0, second = 0;  ///< φ (Pa m), φ′ (Pa, negative in contact), φ″ (Pa/m, positive)
  };
  bool feasible(double g_m) const { return g_m > -guard_m; }
  bool acts(double g_m) const { return g_m < 0.5 * width_m; }
  Value at(double g_m) const {
    const double a = g_m + 0.5 * width_m, least = 0.15 * width_m;
    if (a >= least) return exact(a);
    Value v = exact(least);
    const double d = a - least;
    v.energy += v.first * d + 0.5 * v.second * d * d;
    v.first += v.second * d;
    return v;
  }

 private:
  Value exact(double a) const {
    const double b = a - width_m, log = std::log(a / width_m);
    return {-kappa_Pa_m * b * b * log, -kappa_Pa_m * (2 * b * log + b * b / a),
            -kappa_Pa_m * (2 * log + 4 * b / a - b * b / (a * a))};
  }
};

}  // namespace glisson::mechanics
