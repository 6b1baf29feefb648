// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/progress.h"
#include "mechanics/loads.h"
#include "mechanics/tet_mesh.h"

namespace glisson::mechanics {

/// K u = f on any tetrahedral mesh. Supports and loads belong to the nodes of the mesh.
struct TetProblem {
  TetMesh mesh;
  double poisson = 0.45;
  Supports supports;
  NodalField f_N;  ///< 3 × nodes
};

/// Static linear solve. SolverOptions::kind: Factorised (up to StaticSolver::factorisedLimit degrees of freedom), Cg
/// (block-Jacobi, or none where the preconditioner is None), Auto takes the first as far as it goes. element plays no
/// role. Solution as StaticSolver gives it, on the mesh's nodes. Throws BadInput: Multigrid (it needs voxels), a
/// modulus or Poisson's ratio out of range, a flat or inverted tetrahedron, nodes that no tetrahedron has,
/// contradicting fixations, a piece of the mesh that may move as a rigid body, a load that is not finite; BadArgument
/// on wrong sizes.
Solution solveTets(const TetProblem& problem, const SolverOptions& options = {}, const Progress& progress = {});

/// Shape functions of tetrahedra: 4 or 10 nodes.
enum class TetOrder { Linear, Quadratic };

/// A voxel problem on tetrahedra. Nodes of the voxel mesh are the corners. In T10 a middle node is held along an axis
/// where all corners of an outer face, or of a tetrahedron, that it belongs to are; forces and springs stay at the
/// corners, which is right for T4 only: layFoundations and tractions (VoxelFacesOnTets) put them where T10 has them.
TetProblem onTetrahedra(const Problem& problem, TetOrder order, TetPattern pattern = TetPattern::Mirrored);

/// Replaces the springs of tets = onTetrahedra(problem) by foundations on the voxels' outer faces, lumped by the
/// weights of the triangles (VoxelFacesOnTets::shares): on T10 at the middle nodes, where springs at the corners would
/// be 3 to 4 % too soft. Throws BadArgument where a face is not made of two triangles.
void layFoundations(TetProblem& tets, const VoxelMesh& voxels, const std::vector<Foundation>& foundations);

/// Solves it and gives the answer on the voxel mesh's nodes (reactions of middle nodes go to the ends of their edge,
/// half each). tets: onTetrahedra(problem), its loads perhaps replaced. Throws BadInput as StaticSolver does.
Solution solveTets(const Problem& problem, const TetProblem& tets, const SolverOptions& options,
                   const Progress& progress = {});

}  // namespace glisson::mechanics
