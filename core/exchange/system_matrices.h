// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "retraction/setup.h"
#include "retraction/simulate.h"

namespace glisson::exchange {

/// Writes the whole system K u = f of a scene into a folder, for those who bring their own solver: K.mtx, M.mtx and
/// springs.mtx (matrices.h), f.mtx (all loads, N), nodes.csv (positions in LPS mm) and fixed.csv (unknowns that are
/// held, and at which displacement in m). Unknown 3 n + a is the displacement of node n along LPS axis a; the stiffness
/// of the supported body is K + springs. Throws BadInput where the model is not made of voxel hexahedra (fem-tet),
/// where a support holds a direction oblique to the patient's axes, or beyond 1.2 million unknowns.
std::vector<std::filesystem::path> writeSystem(const std::filesystem::path& folder, const retraction::Model& model,
                                               const retraction::Setup& setup);

}  // namespace glisson::exchange
