// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "anatomy/mesh_quality.h"
#include "anatomy/triangle_mesh.h"
#include "base/progress.h"
#include "image/volume.h"

namespace glisson::anatomy {

/// Size and quality of the tetrahedra of a volume mesh.
struct TetrahedraOptions {
  double cell_mm = 10.0;  ///< edge of the cells, about: no circumsphere is larger than 0.7 × this
  /// A tool along a segment (a point: both ends the same), LPS mm. Within toolReach_mm of it cells are toolCell_mm;
  /// from there their size grows by 0.3 mm per mm up to cell_mm.
  std::optional<std::array<Eigen::Vector3d, 2>> tool = std::nullopt;
  double toolCell_mm = 4.0;
  double toolReach_mm = 10.0;
  double surfaceError_mm = 0.0;    ///< how far a boundary triangle may stay off the surface; 0: cell_mm / 20
  double leastDihedral_deg = 5.0;  ///< gate
  double largestRadiusEdge = 4.0;  ///< gate
  double volumeTolerance = 0.005;  ///< gate: of the volume of the voxels that are meshed
};

/// Tetrahedra in the patient frame.
struct TetrahedralMesh {
  Eigen::Matrix3Xd points_lps_mm;
  Eigen::Matrix4Xi cells;  ///< positively oriented
  TriangleMesh boundary;   ///< on the same points, outward; cavities included
  MeshQuality quality;
  double voxelVolume_mm3 = 0.0;  ///< of the mask as it came
  double dropped_mL = 0.0;       ///< parts smaller than a cell, left out
  double filled_mL = 0.0;        ///< cavities smaller than a cell, filled
  std::string note;              ///< what was made, dropped and filled, in words
};

/// Tetrahedra by Delaunay refinement (CGAL) of the smooth body of a mask, the one of surface.h, on any grid. Parts
/// (voxels that share faces) smaller than one cell are left out, the largest never; cavities smaller than one cell are
/// filled; other parts and cavities are kept. Slivers are perturbed and exuded. The boundary is then moved along its
/// normals so that the volume of the voxels is kept. The same mask gives the same bits with any number of threads.
/// Throws BadInput: empty mask; sizes that are not positive; more than five million cells to be expected; a mesh that
/// fails a gate (flat or inverted cells, smallest dihedral angle, radius over edge, volume, a boundary that is not
/// closed), with the figures.
TetrahedralMesh tetrahedra(const image::Mask& mask, const TetrahedraOptions& options, const Progress& progress = {});

}  // namespace glisson::anatomy
