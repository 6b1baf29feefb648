// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/progress.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Sign of the tangent stiffness at a displacement: what becomes of the body when it is disturbed there.
enum class Stability {
  Stable,    ///< positive definite, as far as the solver met it
  Unstable,  ///< some direction has no stiffness or less: the body buckles or snaps through before it gets here
  Unknown
};

/// What linear theory misses at its own answer, to first order.
struct LinearGap {
  bool computed = false;
  NodalField correction_m;  ///< 3 × nodes, 0 where the supports prescribe; empty unless computed
  Stability stability = Stability::Unknown;
  std::string why;  ///< where it is not computed
};

/// One Newton step of corotational theory (any rotation, small strain) from the linear answer u_m of the problem:
/// correction = K_T(u)⁻¹ (K u − f_int(u)), K_T the exact tangent with its geometric part, loads kept dead, supports as
/// prescribed. K u is the load where u_m solves the problem on these voxels; in this form the correction holds for an
/// answer of another mesh too. It is quadratic in a small load, its own error of third order, and it grows without
/// bound near a loss of stability. The sign of K_T comes from a Cholesky factor up to 3,000 degrees of freedom and from
/// conjugate gradients above, which also solve for a random smooth load so that a symmetric mode cannot hide; a mode
/// whose stiffness is below a ten-thousandth of the body's softest may be missed. Not computed: nothing holds the body,
/// a cell of the linear answer is inside out, the body has more than largeDeformationLimit degrees of freedom, or no
/// solver comes near. options.element is that of the linear answer. Throws BadArgument on wrong sizes; Cancelled. The
/// same bits with any number of threads.
LinearGap linearGap(const Problem& problem, const NodalField& u_m, const SolverOptions& options = {},
                    const Progress& progress = {});

}  // namespace glisson::mechanics
