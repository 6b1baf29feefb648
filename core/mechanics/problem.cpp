// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/problem.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

#include "base/error.h"

namespace glisson::mechanics {
namespace {

/// Stiffer than any solid (diamond: 1.2e12 Pa): a unit was mistaken, or a fill value was read as a modulus.
constexpr double largestModulus_Pa = 1e14;

void checkBody(const VoxelBody& body) {
  std::ostringstream what;
  if ((body.cells.array() < 1).any()) {
    what << "the voxel body has " << body.cells.transpose() << " cells; each axis needs at least 1";
    throw BadInput(what.str());
  }
  if (!body.h_m.allFinite() || (body.h_m.array() <= 0).any()) {
    what << "the cell edges are " << body.h_m.transpose() << " m; they must be positive and finite";
    throw BadInput(what.str());
  }
  const std::size_t count = static_cast<std::size_t>(body.cells.x()) * static_cast<std::size_t>(body.cells.y()) *
                            static_cast<std::size_t>(body.cells.z());
  if (body.E_Pa.size() != count) {
    what << "the voxel body has " << count << " cells but " << body.E_Pa.size() << " moduli; give one per cell";
    throw BadInput(what.str());
  }
  if (!(body.poisson > -1.0 && body.poisson < 0.5)) {
    what << "Poisson's ratio is " << body.poisson
         << "; it must lie above -1 and below 0.5 (0.49 is nearly incompressible)";
    throw BadInput(what.str());
  }
  if (!(std::isfinite(body.density_kg_m3) && body.density_kg_m3 > 0)) {
    what << "the density is " << body.density_kg_m3 << " kg/m3; it must be positive and finite";
    throw BadInput(what.str());
  }
  for (int k = 0; k < body.cells.z(); ++k)
    for (int j = 0; j < body.cells.y(); ++j)
      for (int i = 0; i < body.cells.x(); ++i) {
        const double E = body.E_Pa[body.cell(i, j, k)];
        if (std::isfinite(E) && E >= 0 && E <= largestModulus_Pa) continue;
        what << "Young's modulus of cell (" << i << ", " << j << ", " << k << ") in slice " << k << " is " << E
             << " Pa; it must be 0 (empty) or positive, finite and at most " << largestModulus_Pa
             << ". Check the unit and the fill value of the stiffness map";
        throw BadInput(what.str());
      }
}

}  // namespace

VoxelMesh::VoxelMesh(const VoxelBody& body) : cells_(body.cells), h_m_(body.h_m) {
  checkBody(body);
  const Eigen::Vector3i n = cells_ + Eigen::Vector3i::Ones();
  const auto at = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(n.x()) +
           static_cast<std::size_t>(i);
  };
  nodeOfLattice_.assign(at(n.x() - 1, n.y() - 1, n.z() - 1) + 1, -1);
  for (int k = 0; k < cells_.z(); ++k)
    for (int j = 0; j < cells_.y(); ++j)
      for (int i = 0; i < cells_.x(); ++i) {
        if (body.E_Pa[body.cell(i, j, k)] == 0) continue;
        filled_.emplace_back(i, j, k);
        for (int a = 0; a < 8; ++a) nodeOfLattice_[at(i + (a & 1), j + (a >> 1 & 1), k + (a >> 2 & 1))] = 0;
      }
  if (filled_.empty())
    throw BadInput("the voxel body has no filled cell: the region is empty or its modulus is 0 everywhere");
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        int& node = nodeOfLattice_[at(i, j, k)];
        if (node < 0) continue;
        node = static_cast<int>(lattice_.size());
        lattice_.emplace_back(i, j, k);
      }
}

int VoxelMesh::nodeAt(int i, int j, int k) const {
  if (i < 0 || j < 0 || k < 0 || i > cells_.x() || j > cells_.y() || k > cells_.z()) return -1;
  const auto nx = static_cast<std::size_t>(cells_.x() + 1);
  const auto ny = static_cast<std::size_t>(cells_.y() + 1);
  return nodeOfLattice_[(static_cast<std::size_t>(k) * ny + static_cast<std::size_t>(j)) * nx +
                        static_cast<std::size_t>(i)];
}

bool VoxelMesh::isFilled(int i, int j, int k) const {
  const Eigen::Vector3i wanted(i, j, k);
  const auto before = [](const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  };
  return std::binary_search(filled_.begin(), filled_.end(), wanted, before);
}

std::array<int, 8> VoxelMesh::nodesOf(int filledCell) const {
  const Eigen::Vector3i c = cellOf(filledCell);
  std::array<int, 8> nodes{};
  for (int a = 0; a < 8; ++a)
    nodes[static_cast<std::size_t>(a)] = nodeAt(c.x() + (a & 1), c.y() + (a >> 1 & 1), c.z() + (a >> 2 & 1));
  return nodes;
}

}  // namespace glisson::mechanics
