// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/row_lattice.h"

#include <algorithm>

namespace glisson::mechanics {

RowLattice::RowLattice(const Eigen::Vector3i& cells, const std::vector<double>& E) : cells_(cells) {
  const int nx = cells.x();
  const int ny = cells.y();
  const int nz = cells.z();
  cellRows_.resize(static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  for (std::size_t r = 0; r < cellRows_.size(); ++r) {
    const auto first = E.begin() + static_cast<std::ptrdiff_t>(r * static_cast<std::size_t>(nx));
    const auto last = first + nx;
    const auto begin = std::find_if(first, last, [](double e) { return e != 0; });
    if (begin == last) continue;
    auto end = last;
    while (*(end - 1) == 0) --end;
    Row& row = cellRows_[r];
    row.begin = static_cast<int>(begin - first);
    row.length = (static_cast<int>(end - begin) + pad - 1) / pad * pad;
    row.offset = cellSlots_;
    cellSlots_ += static_cast<std::size_t>(row.length);
  }
  nodeRows_.resize(static_cast<std::size_t>(ny + 1) * static_cast<std::size_t>(nz + 1));
  for (int k = 0; k <= nz; ++k) {
    layerBegin_.push_back(nodeSlots_);
    for (int j = 0; j <= ny; ++j) {
      int begin = nx + 1;
      int end = 0;
      for (int c = std::max(0, k - 1); c <= std::min(nz - 1, k); ++c)
        for (int b = std::max(0, j - 1); b <= std::min(ny - 1, j); ++b) {
          const Row& cellsHere = cellRow(b, c);
          if (cellsHere.length == 0) continue;
          begin = std::min(begin, cellsHere.begin);
          end = std::max(end, cellsHere.begin + cellsHere.length + 1);
        }
      Row& row =
          nodeRows_[static_cast<std::size_t>(k) * static_cast<std::size_t>(ny + 1) + static_cast<std::size_t>(j)];
      if (end == 0) continue;
      row.begin = begin;
      row.length = end - begin;
      row.offset = nodeSlots_;
      nodeSlots_ += static_cast<std::size_t>(row.length);
    }
  }
  layerBegin_.push_back(nodeSlots_);
  // Two layers per task keep neighbouring layers in cache; a small body is one task.
  layersPerChunk_ = nodeSlots_ < 6000 ? nz : 2;
}

}  // namespace glisson::mechanics
