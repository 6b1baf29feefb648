// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy/triangle_mesh.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// Isosurface: marching cubes on a lattice. Delaunay: refinement of the same smooth body, fewer and rounder triangles
/// (no angle below 28 degrees).
enum class SurfaceMethod { Isosurface, Delaunay };

/// How a surface is made of a mask.
struct SurfaceOptions {
  double resolution_mm = 0.0;  ///< edge of the triangles, about; 0: the in-plane spacing, or 1/128 of the extent where
                               ///< that is more (isosurface); 1/16 of the extent (Delaunay)
  int smoothing = 20;          ///< iterations of the windowed sinc filter (isosurface)
  SurfaceMethod method = SurfaceMethod::Isosurface;
};

/// Smooth closed surface of a mask, outward oriented, that encloses the volume of its voxels (within 0.1 %).
/// Thick slices (more than 1.5 × the in-plane spacing) are interpolated by shape: signed distances to the outline in
/// each slice, linear in between [raya1990]; beyond the first and last slice the surface ends half a slice further, as
/// the voxels do. Otherwise the signed distance in 3-D. The level of the field is set, and the finished surface moved
/// along its normals, so that the volume is kept. Every part and cavity of the mask has its surface. Throws BadInput
/// where the mask is empty.
TriangleMesh liverSurface(const image::Mask& mask, const SurfaceOptions& options = {});

}  // namespace glisson::anatomy
