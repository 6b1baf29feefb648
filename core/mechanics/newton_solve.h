// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/progress.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Kinematics for rotations and strains beyond linear theory, on voxel hexahedra, static.
enum class LargeDeformationKind {
  Corotational,  ///< any rotation, small strain; the element of the options, turned with each cell (CorotationalHex)
  Hyperelastic   ///< any rotation and strain, neo-Hookean; mean-dilatation hexahedra whatever the options name
                 ///< (NeoHookeanHex)
};

inline constexpr int largeDeformationLimit = 1500000;  ///< degrees of freedom; the tangent takes 0.7 kB for each

/// Solves f_int(u) + springs u = f with prescribed displacements by Newton's method. Loads are dead loads: they keep
/// their direction and size. The whole load is tried at once; where Newton's method fails or a cell would turn inside
/// out (at its centre or a corner), half of it is, from a quarter on with a line search on the potential energy as
/// well, and steps grow again. An attempt is given up where the residual fails to halve
/// four times in a row (eight with line search). Ends below 1/128 of the load, after 200 iterations, or after 60 in
/// attempts that failed. Tangents are solved, by
/// SolverOptions::kind: Factorised; Cg with the preconditioner; Multigrid (of the undeformed body) inside conjugate
/// gradients; Auto takes Factorised up to 3000 degrees of freedom, Multigrid above, and Factorised again (up to
/// StaticSolver::factorisedLimit) where that does not converge. iterations limits the iterations of each inner solve.
/// Solution: u_m and reaction_N at the fraction of the load reached; energy_J is the elastic energy, springs included.
/// Report: kind "newton-…"; iterations: Newton iterations of all steps, failed ones too; residual: ‖P(f − f_int)‖ / ‖P
/// f‖ of the whole load, P the free degrees of freedom (where displacements are prescribed, the forces that hold them
/// are part of the denominator); Converged at the tolerance, or at the rounding of double precision, which `why` then
/// names; StoppedAtLimit where the load could not be applied in full: `why` states the fraction reached. f = 0 without
/// prescribed displacements gives exactly u = 0. The same bits with any number of threads. Throws BadInput as
/// StaticSolver does, and above largeDeformationLimit; Cancelled.
Solution solveLargeDeformation(const Problem& problem, LargeDeformationKind kind, const SolverOptions& options = {},
                               const Progress& progress = {});

}  // namespace glisson::mechanics
