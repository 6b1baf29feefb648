// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace glisson::mechanics {

/// Storage of nodal and cell data of a voxel body for vector kernels: rows along x, each stored from the first to the
/// last filled cell only (empty cells of the bounding box cost nothing; holes inside a row are stored, with modulus 0).
/// Cell rows are padded to a multiple of `pad` cells, node rows reach one node beyond, so that a kernel may run over
/// whole vectors. A nodal field is three arrays (x, y, z) of nodeSlots() values, one behind the other; slots that
/// belong to no filled cell hold 0.
class RowLattice {
 public:
  static constexpr int pad = 16;

  /// The node slots of one row along x.
  struct Row {
    int begin = 0;           ///< first i
    int length = 0;          ///< slots
    std::size_t offset = 0;  ///< slot of `begin`
  };

  /// E: cells, x fastest; 0 = empty.
  RowLattice(const Eigen::Vector3i& cells, const std::vector<double>& E);

  const Eigen::Vector3i& cells() const { return cells_; }
  const Row& nodeRow(int j, int k) const {
    return nodeRows_[static_cast<std::size_t>(k) * static_cast<std::size_t>(cells_.y() + 1) +
                     static_cast<std::size_t>(j)];
  }
  const Row& cellRow(int j, int k) const {
    return cellRows_[static_cast<std::size_t>(k) * static_cast<std::size_t>(cells_.y()) + static_cast<std::size_t>(j)];
  }
  std::size_t nodeSlots() const { return nodeSlots_; }
  std::size_t cellSlots() const { return cellSlots_; }
  /// Slot of a node that is stored.
  std::size_t slot(int i, int j, int k) const {
    const Row& row = nodeRow(j, k);
    return row.offset + static_cast<std::size_t>(i - row.begin);
  }
  /// Slots of node layer k: [layerBegin(k), layerBegin(k + 1)).
  std::size_t layerBegin(int k) const { return layerBegin_[static_cast<std::size_t>(k)]; }
  /// Cell layers that one thread takes at a time; a function of the body's size only.
  int layersPerChunk() const { return layersPerChunk_; }

 private:
  Eigen::Vector3i cells_;
  std::vector<Row> nodeRows_;
  std::vector<Row> cellRows_;
  std::vector<std::size_t> layerBegin_;
  std::size_t nodeSlots_ = 0;
  std::size_t cellSlots_ = 0;
  int layersPerChunk_ = 1;
};

}  // namespace glisson::mechanics
