// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "mechanics/problem.h"

namespace glisson::retraction {

constexpr double barBehind_mm = 400.0;  ///< from where a rigid bar comes, behind its place

namespace detail {

/// The node at a place of the lattice, or one within three cells of it; −1 where there is none.
int nodeNear(const mechanics::VoxelMesh& mesh, const Eigen::Vector3i& at);

}  // namespace detail
}  // namespace glisson::retraction
