// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/progress.h"

namespace glisson::study {

/// Which equations a chosen displacement is put into.
enum class Manufactured {
  VaryingModulus,  ///< linear, Young's modulus 1 + 0.8 sin 2πx sin 2πy sin 2πz times its mean: a contrast of 9
  FiniteStrain     ///< neo-Hookean, strains up to a third
};

/// How the solver's error falls where the answer was chosen first and the body force made to fit it.
struct ManufacturedResult {
  std::string what;
  int coarse = 0, fine = 0;                   ///< cells along an edge of the unit cube
  double coarseError = 0.0, fineError = 0.0;  ///< largest over the nodes, over the largest displacement chosen
  double order = 0.0;                         ///< log2 of their ratio; trilinear elements promise 2
  bool converged = false;                     ///< both solves
};

/// u = A v sin πx sin πy sin πz on the unit cube held at its surface, Poisson's ratio 0.3; the body force −div P is
/// taken from the stress P by central differences and integrated by 3 × 3 × 3 Gauss points. Solved with `cells` and
/// twice as many cells along an edge (cells even, at least 4). Throws BadArgument, Cancelled.
ManufacturedResult solveManufactured(Manufactured kind, int cells, const Progress& progress = {});

}  // namespace glisson::study
