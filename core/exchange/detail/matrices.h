// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "mechanics/problem.h"
#include "retraction/body.h"

namespace glisson::exchange {

/// Writes K.mtx and M.mtx (Matrix Market, coordinate real symmetric, lower triangle) of a voxel body into a folder and
/// gives the files. K is the body's own stiffness in N/m (the same number in mN/mm), without supports; M the consistent
/// mass in kg. Unknown 3 n + a + 1 is the displacement of node n (from 0, as in exported meshes) along the patient's
/// axis a (0, 1, 2 = L, P, S). Rows are written as they are made: the memory needed does not grow with the body.
/// Throws BadInput where a file cannot be written.
std::vector<std::filesystem::path> writeMatrices(const std::filesystem::path& folder, const retraction::Body& body,
                                                 mechanics::HexElement element);

/// Writes springs.mtx, the supports that are springs, in the same numbering and units; nothing where there are none.
std::vector<std::filesystem::path> writeSpringMatrix(const std::filesystem::path& folder, const retraction::Body& body,
                                                     const mechanics::Supports& supports);

}  // namespace glisson::exchange
