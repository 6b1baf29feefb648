// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mechanics/meshfree.h"
#include "mechanics/problem.h"

namespace glisson::study {

/// One way to answer a scene.
struct Variant {
  enum class Kind { Voxels, Tetrahedra, Frames, Condensed, Corotational } kind = Kind::Voxels;
  std::string method{};
  double factor = 1.0;  ///< cells are this much longer than the scene's own
  mechanics::SolverOptions solver{};
  bool quadraticTets = false;
  mechanics::MeshfreeOptions meshfree{};
  std::string also{};         ///< goes behind the resolution
  std::size_t mostCells = 0;  ///< left out for bodies of more cells than this (they would take minutes); 0: no limit
};

/// What the trade-off tries on a body of so many cells and voxel nodes, coarse before fine. Frames that the voxels have
/// no room for are not in it; left out: in words, which.
std::vector<Variant> tradeoffVariants(bool quick, std::size_t cells, int nodes, std::uint64_t seed,
                                      std::vector<std::string>& leftOut);

}  // namespace glisson::study
