// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/enum_names.h"
#include "mechanics/kernel.h"
#include "mechanics/problem.h"

/// The words of a scene for the choices of mechanics, for its reader and its writer.
namespace glisson::pipeline::detail {

inline constexpr auto hexElementNames = enumNames<mechanics::HexElement>({
    {"H8", mechanics::HexElement::H8},
    {"H8-Bbar", mechanics::HexElement::BBar},
    {"H8-incompatible", mechanics::HexElement::Incompatible},
});

inline constexpr auto kernelNames = enumNames<mechanics::Kernel>({
    {"voronoi", mechanics::Kernel::Voronoi},
    {"wendland", mechanics::Kernel::Wendland},
    {"mls", mechanics::Kernel::Mls},
});

/// A scene knows "condensed" too, which is no solver of mechanics.
inline constexpr auto solverNames = enumNames<mechanics::SolverKind>({
    {"auto", mechanics::SolverKind::Auto},
    {"cg", mechanics::SolverKind::Cg},
    {"factorised", mechanics::SolverKind::Factorised},
    {"multigrid", mechanics::SolverKind::Multigrid},
});
inline constexpr const char* condensedSolver = "condensed";

inline constexpr auto preconditionerNames = enumNames<mechanics::Preconditioner>({
    {"none", mechanics::Preconditioner::None},
    {"jacobi", mechanics::Preconditioner::Jacobi},
    {"block-jacobi", mechanics::Preconditioner::BlockJacobi},
});

}  // namespace glisson::pipeline::detail
