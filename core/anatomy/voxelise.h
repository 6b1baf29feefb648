#pragma once

#include <optional>

#include "anatomy/triangle_mesh.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// The voxels of the grid whose centres lie inside the closed surface (even-odd: a cavity, or a second surface inside
/// the first, is outside). Exact to rounding: the centres are shifted by 1e-7 voxels so that none lies on an edge.
/// Throws BadInput where the surface is not closed.
image::Mask voxelise(const TriangleMesh& mesh, const image::Grid& grid);

/// A grid along the patient axes round the surface with two voxels of margin. spacing_mm absent: isotropic, 256 voxels
/// along its longest side, 0.2 mm at least. Throws BadInput where the surface has no extent, or more than 2e8 voxels.
image::Grid gridAround(const TriangleMesh& mesh, std::optional<Eigen::Vector3d> spacing_mm = {});

}  // namespace glisson::anatomy
