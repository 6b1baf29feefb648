// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "base/progress.h"
#include "mechanics/contact/contact_energy.h"

namespace glisson::mechanics {

/// What a Newton run aims at.
struct NewtonGoal {
  std::optional<double> force_N;  ///< the bar is free and pushed by this; else it stays where it is
  double tolerance = 1e-6;        ///< on ‖gradient‖ / load
  int limit = 60;                 ///< iterations
  int innerLimit = 200;           ///< iterations of the inner solve with each tangent
};

/// How a minimisation ended.
struct NewtonRun {
  bool converged = false;
  bool indefinite = false;  ///< the tangent had a direction of negative curvature at the last iteration
  int iterations = 0, inner = 0;
  double residual = 0;  ///< ‖gradient‖ / load at the end
};

/// Minimises the potential on its level from `state`. Steps are limited to 10 mm, follow the exact tangent (its
/// positive part where that gives no descent), and are halved until the potential falls and no sample of the surface
/// passes through the bar. At rounding a smaller gradient is accepted instead. Without a potential
/// (ContactEnergy::hasPotential) steps are those of the unsymmetric tangent, and the work of the unbalanced forces
/// along them stands for its fall.
NewtonRun minimise(SolidHierarchy& hierarchy, const ContactEnergy& energy, ContactEnergy::State& state,
                   const NewtonGoal& goal, const Progress& progress);

}  // namespace glisson::mechanics
