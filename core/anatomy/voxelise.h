// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "anatomy/triangle_mesh.h"
#include "base/diagnostic.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// The voxels of the grid whose centres lie inside the closed surface. Its shells are sets of points
/// (roi::arrangeSets): those that cross are one body, one inside another is a cavity, one that repeats another (within
/// 0.5 mm on the average) counts once; a shell that crosses itself is filled by the even-odd rule. Exact to rounding:
/// the centres are shifted by 1e-7 voxels so that none lies on an edge. doubts (may be null): shells that repeat or
/// cross others, cavities that are turned like bodies, shells too small to hold a voxel. Throws BadInput where the
/// surface is not closed.
image::Mask voxelise(const TriangleMesh& mesh, const image::Grid& grid, Diagnostics* doubts = nullptr);

/// A grid along the patient axes round the surface with two voxels of margin. spacing_mm absent: isotropic, 256 voxels
/// along its longest side, 0.2 mm at least. Throws BadInput where the surface has no extent, or more than 2e8 voxels.
image::Grid gridAround(const TriangleMesh& mesh, std::optional<Eigen::Vector3d> spacing_mm = {});

}  // namespace glisson::anatomy
