// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/progress.h"
#include "retraction/body.h"

namespace glisson::retraction {

/// The answer on tetrahedra.
struct DelaunayAnswer {
  mechanics::Solution solution;  ///< u_m on the nodes of the voxel mesh; reaction_N on those of the tetrahedra
  int dofs = 0;
  std::string note;  ///< the mesh, in words
};

/// The scene on tetrahedra by Delaunay refinement of the organ's smooth surface (anatomy/tetrahedra.h), finer near the
/// retractor; static and linear. How the voxel scene is carried over:
/// - a tetrahedron's modulus is the mean over the filled voxels whose centres it holds, or that of the nearest one;
/// - a body force keeps its sum over the voxels (the mesh's volume differs by less than 0.5 %);
/// - a traction or a spring on a voxel face acts at the nearest points of the mesh's surface, in pieces no larger than
///   half an edge of its triangles, so that force and stiffness keep their sums;
/// - a surface node is held as the nearest surface node of the voxels is, an inner one as the nearest inner node.
/// The displacement at a voxel node is that of the tetrahedron that holds it; beyond the surface it is continued from
/// the nearest one by its gradient, over one voxel diagonal at most.
/// Throws BadInput where the mesh fails its gates (anatomy::tetrahedra), or holds no node of a support.
DelaunayAnswer solveOnDelaunay(const Model& model, const Body& body, const MechanicsScene& scene, const Setup& setup,
                               const Progress& progress);

}  // namespace glisson::retraction
