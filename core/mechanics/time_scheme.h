// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glisson::mechanics {

/// How a step is made; all are unconditionally stable.
enum class TimeScheme {
  ImplicitEuler,    ///< first order; damps every motion, the more the longer the step
  Newmark,          ///< average acceleration [newmark1959method]: second order, keeps the energy of an undamped motion
  GeneralisedAlpha  ///< [chung1993time]: second order, damps what the step does not resolve
};

/// "implicit-euler", "newmark", "generalised-alpha".
const char* nameOf(TimeScheme scheme);

}  // namespace glisson::mechanics
