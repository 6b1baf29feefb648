// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/problem.h"

namespace glisson::mechanics {

/// How many frames, and where they sit densest.
struct SiteOptions {
  int count = 200;
  int iterations = 25;          ///< of Lloyd's method
  std::uint64_t seed = 1;       ///< of the first guess
  std::vector<double> density;  ///< one per filled cell, > 0; more sites where it is larger; empty = uniform
  int minimumNodes = 27;        ///< voxel nodes that a site's Voronoi cell must hold; fewer sites are placed otherwise
};

/// Where the frames of a mesh-free model sit: a centroidal Voronoi decomposition of the filled cells.
struct Sites {
  Eigen::Matrix3Xd position_m;     ///< 3 × n, each inside a filled cell
  Eigen::VectorXd spacing_m;       ///< n, cube root of the Voronoi cell's filled volume
  std::vector<int> ownerOfNode;    ///< nodeCount, the nearest site
  std::vector<int> nodesOf;        ///< n, voxel nodes owned
  std::vector<std::string> notes;  ///< what was changed and why (fewer sites than asked for)
  int count() const { return static_cast<int>(spacing_m.size()); }
};

/// Lloyd's method on the centres of the filled cells. Deterministic: same mesh, options and seed give the same bits.
/// Throws BadInput where count < 1 or the density has a wrong length or a value that is not positive.
Sites placeSites(const VoxelMesh& mesh, const SiteOptions& options, const Progress& progress = {});

/// Sites at given places (3 × n, m, the grid's axes). What cannot carry a frame is left out, with a note: a site
/// outside the body, a duplicate (closer than a thousandth of the shortest cell edge to an earlier one), and, the
/// poorest first, sites whose cells hold fewer than minimumNodes voxel nodes. Throws BadInput where none is left or a
/// coordinate is not finite.
Sites sitesAt(const VoxelMesh& mesh, const Eigen::Matrix3Xd& position_m, int minimumNodes = 27);

/// The most sites that placeSites gives a body of so many voxel nodes and filled cells.
int mostSites(double nodes, double cells, int minimumNodes);

/// For each point (3 × m) the index of the nearest site (3 × n, n ≥ 1), the lowest index among equals. Euclidean.
std::vector<int> nearestSite(const Eigen::Matrix3Xd& sites, const Eigen::Matrix3Xd& points);

}  // namespace glisson::mechanics
