// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Tetrahedra of 4 nodes (T4) or 10 (T10). Node order: corners 0 to 3, positively oriented (3 on the side of (1−0) ×
/// (2−0)); T10 then has the middles of edges 01, 12, 20, 03, 13, 23, which may lie off the straight edge (curved).
struct TetMesh {
  Eigen::Matrix3Xd nodes_m;  ///< 3 × nodes
  Eigen::MatrixXi tets;      ///< 4 or 10 × tetrahedra
  Eigen::VectorXd E_Pa;      ///< one per tetrahedron, > 0

  bool quadratic() const { return tets.rows() == 10; }
  int nodeCount() const { return static_cast<int>(nodes_m.cols()); }
  int tetCount() const { return static_cast<int>(tets.cols()); }
};

/// The two corners of each of the six edges, in the order of the T10 middles.
inline constexpr std::array<std::array<int, 2>, 6> tetEdges = {
    {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{0, 3}}, {{1, 3}}, {{2, 3}}}};
/// Corners of the four faces, counter-clockwise from outside.
inline constexpr std::array<std::array<int, 3>, 4> tetFaces = {{{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}};

/// How the diagonals of neighbouring cells lie. Mirrored: as mirror images, no direction preferred; linear tetrahedra
/// lock several times less on it. Parallel: all the same way, as stiff as an unstructured mesh and stiffer.
enum class TetPattern { Mirrored, Parallel };

/// T4 mesh of a voxel body: each filled cell becomes six tetrahedra around a diagonal [kuhn1960some], so that faces
/// match in either pattern. Node numbers are those of the voxel mesh.
TetMesh tetrahedra(const VoxelBody& body, const VoxelMesh& mesh, TetPattern pattern = TetPattern::Mirrored);

/// The T10 mesh with a middle node on every straight edge, numbered behind the corners in the order in which the
/// tetrahedra meet them. Throws BadArgument where the mesh is quadratic already.
TetMesh withMiddles(const TetMesh& linear);

/// A face that belongs to one tetrahedron only.
struct TetFace {
  int tet = 0;
  int face = 0;  ///< of tetFaces
};
std::vector<TetFace> exteriorFaces(const TetMesh& mesh);
/// 3 or 6 nodes of a face: corners, then the middles of 01, 12, 20.
std::vector<int> nodesOf(const TetMesh& mesh, const TetFace& face);

/// Shape functions (4 or 10 values, sum 1) and their derivatives (4 or 10 × 3) by the coordinates (ξ, η, ζ) of corners
/// 1, 2, 3; corner 0 is the origin.
Eigen::VectorXd tetShape(bool quadratic, const Eigen::Vector3d& xi);
Eigen::Matrix<double, Eigen::Dynamic, 3> tetShapeDerivatives(bool quadratic, const Eigen::Vector3d& xi);

/// Consistent nodal forces (3 × nodes, N): of a force density over the whole body, and of a traction on faces.
NodalField bodyForce(const TetMesh& mesh, const Eigen::Vector3d& density_N_m3);
NodalField tractionForce(const TetMesh& mesh, const std::vector<TetFace>& faces, const Eigen::Vector3d& traction_Pa);

}  // namespace glisson::mechanics
