// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics::bench {

/// A liver-like problem of about 1.5 litres: two lobes, moduli that vary smoothly within a factor of 4 around 6 kPa,
/// Winkler foundation of 0.2 kPa/mm at the back and on top, 15.7 N over a soft contact (σ 15 mm) in front.
/// dofs: about how many degrees of freedom; slice_m: cell height, 0 = cubes.
Problem liver(int dofs, double poisson, double slice_m = 0.0);

/// The same with a stiff ball of `contrast` times the modulus inside.
Problem liverWithTumour(int dofs, double poisson, double contrast);

/// A cube of 0.1 m and cells³ cells of 6 kPa, a ball of `contrast` times that inside, clamped below, pulled and sheared
/// above.
Problem clampedBox(int cells, double poisson, double contrast);

/// `count` tool contacts on the front surface, 1 N each.
std::vector<NodalField> contacts(const Problem& problem, int count);

/// Memory of this process, MB. resetPeak() forgets the highest so far.
void resetPeak();
double peak_MB();
double resident_MB();

/// Bytes per second of a triad a = b + s c over arrays far larger than the caches, with the threads in use; measured
/// once per thread count, best of several. Counted as two reads and one write.
double triadBytesPerSecond();

}  // namespace glisson::mechanics::bench
