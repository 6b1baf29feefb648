#pragma once

#include <utility>
#include <vector>

#include "mechanics/contact/contact_solve.h"

namespace glisson::mechanics {

/// Trilinear shares of the nodes of the cell that carries a point (m, grid axes), with its place clamped into the cell:
/// none negative, together 1. Empty where no filled cell lies within three cells.
std::vector<std::pair<int, double>> sharesOf(const VoxelMesh& mesh, const Eigen::Vector3d& p_m);

/// Whether pressure on these faces has a potential: every edge belongs to two of them or is held at both ends.
bool haveClosedOrHeldRim(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces,
                         const std::vector<Fixation>& fixations);

/// Forces (N) of the faces' pressures at displacements u (m): pressure times area vector of the deformed face, in equal
/// parts on the corners of its triangles.
NodalField followerForces(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces, const NodalField& u_m);

}  // namespace glisson::mechanics
