// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// One face of a filled cell towards an empty cell or the end of the grid. side: 0 x−, 1 x+, 2 y−, 3 y+, 4 z−, 5 z+.
struct Face {
  int filledCell = 0;
  int side = 0;
  bool operator==(const Face&) const = default;
};

/// Outward unit normal, area (m²), centre (m, the body's axes) and the four nodes of a face.
Eigen::Vector3d faceNormal(int side);
double faceArea_m2(const VoxelMesh& mesh, int side);
Eigen::Vector3d faceCentre_m(const VoxelMesh& mesh, const Face& face);
std::array<int, 4> faceNodes(const VoxelMesh& mesh, const Face& face);

/// Faces towards the outside: the empty cell beyond reaches the end of the grid through faces of empty cells.
std::vector<Face> exteriorFaces(const VoxelMesh& mesh);
/// Faces towards enclosed cavities.
std::vector<Face> cavityFaces(const VoxelMesh& mesh);

/// Consistent nodal forces (3 × nodeCount, N), exact for trilinear shape functions: each of a face's four nodes takes a
/// quarter of traction × area, each of a cell's eight nodes an eighth of force density × volume.
NodalField tractionForce(const VoxelMesh& mesh, const std::vector<Face>& faces, const Eigen::Vector3d& traction_Pa);
/// One traction per face, 3 × faces. Throws BadArgument where the counts differ.
NodalField tractionForce(const VoxelMesh& mesh, const std::vector<Face>& faces, const Eigen::Matrix3Xd& traction_Pa);
/// Pressure on the body, positive pushes inwards.
NodalField pressureForce(const VoxelMesh& mesh, const std::vector<Face>& faces, double pressure_Pa);
/// Force per volume over the whole body; own weight is density × g.
NodalField bodyForce(const VoxelMesh& mesh, const Eigen::Vector3d& density_N_m3);

/// Spring resistance in kPa per mm of displacement is 1e6 times that in N/m³.
inline constexpr double N_m3_per_kPa_mm = 1e6;
enum class SpringDirection { Every, Normal };
/// Winkler foundation on one face: k per area and displacement, symmetric positive semi-definite, N/m³.
struct Foundation {
  Face face;
  Eigen::Matrix3d k_N_m3 = Eigen::Matrix3d::Zero();
};
/// Of stiffness k on faces, as k I or k n nᵀ. Throws BadInput where k is negative or not finite.
std::vector<Foundation> foundations(const std::vector<Face>& faces, double k_N_m3,
                                    SpringDirection direction = SpringDirection::Every);
/// Foundations lumped to nodes by row sums: every face node takes a quarter of k × area.
std::vector<Spring> faceSprings(const VoxelMesh& mesh, const std::vector<Foundation>& foundations);
/// Those of one stiffness on faces. Throws BadInput where k is negative or not finite.
std::vector<Spring> faceSprings(const VoxelMesh& mesh, const std::vector<Face>& faces, double k_N_m3,
                                SpringDirection direction = SpringDirection::Every);

/// All nodes of the faces, ascending, once each.
std::vector<int> nodesOfFaces(const VoxelMesh& mesh, const std::vector<Face>& faces);
/// Fixes the nodes along the axes given, at 0.
std::vector<Fixation> fix(const std::vector<int>& nodes, const std::array<bool, 3>& axis = {true, true, true});

}  // namespace glisson::mechanics
