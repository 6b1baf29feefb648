// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "mechanics/contact/contact_energy.h"

namespace glisson::mechanics {

/// Where a level keeps a node of the body's mesh.
std::size_t slotOf(const SolidLevel& level, const VoxelMesh& mesh, int node);

/// The filled cell that carries a point (m, grid axes): the one it lies in, or the nearest within three cells.
std::optional<Eigen::Vector3i> carrierCell(const VoxelMesh& mesh, const Eigen::Vector3d& p_m);
/// The nearest filled cell, however far.
Eigen::Vector3i nearestCell(const VoxelMesh& mesh, const Eigen::Vector3d& p_m);

/// A skin of this stiffness (N/m, Young's modulus times thickness) as a layer of this depth below the surface: a
/// further modulus of the cells that it passes through, Pa per cell. It stiffens them in all directions; its depth is
/// its own and not that of the cells, so that finer cells show the same body.
std::vector<double> rindOf(const VoxelBody& body, const std::vector<SurfaceSample>& surface, double stiffness_N_m,
                           double depth_m);

/// The body's own cells as a level: moduli, clamps and springs.
SolidLevel finestLevel(const ContactProblem& problem);

/// The samples that a filled cell within three cells can carry, set on all levels of the hierarchy, and behind them the
/// points of the bed and the corners of the follower faces. kept: their indices
/// in problem.surface.
std::vector<SurfaceSample> carriedSurface(SolidHierarchy& hierarchy, const ContactProblem& problem,
                                          std::vector<std::size_t>& kept);

/// Dead loads (3 nodes, N) per level; a coarse level's do the same work on its displacements.
std::vector<std::vector<double>> loadsOnLevels(const SolidHierarchy& hierarchy, const ContactProblem& problem);

/// The coarsest level whose cells can still follow the bar: a path is followed there. The finest where displacements
/// are prescribed.
std::size_t pathLevel(const SolidHierarchy& hierarchy, const ContactProblem& problem);

/// Prescribed displacements at the clamps of the finest level, 0 elsewhere, m.
std::vector<double> prescribedOnFinest(const SolidLevel& level, const ContactProblem& problem);

/// Fills in what the answer at `at` (of the energy's level) shows: displacements and reactions where that level is the
/// finest, contact figures on any.
void describe(const SolidHierarchy& hierarchy, const ContactEnergy& energy, const ContactProblem& problem,
              const std::vector<std::size_t>& kept, const ContactEnergy::State& at, ContactSolution& out);

}  // namespace glisson::mechanics
