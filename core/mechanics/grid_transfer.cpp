// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/grid_transfer.h"

#include <algorithm>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

/// Fine nodes that interpolate from one coarse node along one axis, with weights.
struct Children {
  int count = 0;
  std::array<int, 3> node{};
  std::array<float, 3> weight{};
  Children(int coarse, bool halved, int fineCells) {
    for (int d = halved ? -1 : 0; d <= (halved ? 1 : 0); ++d) {
      const int fine = (halved ? 2 * coarse : coarse) + d;
      if (fine < 0 || fine > fineCells) continue;
      node[static_cast<std::size_t>(count)] = fine;
      weight[static_cast<std::size_t>(count++)] = d == 0 ? 1.0F : 0.5F;
    }
  }
};

/// buffer[i − first] += weight · row[i] over the overlap of [first, first + size) with the row.
void addOverlap(const RowLattice::Row& row, const float* values, float weight, int first, std::vector<float>& buffer) {
  const int begin = std::max(first, row.begin);
  const int end = std::min(first + static_cast<int>(buffer.size()), row.begin + row.length);
  if (end <= begin) return;
  const float* from = values + row.offset + (begin - row.begin);
  float* to = buffer.data() + (begin - first);
  for (int i = 0; i < end - begin; ++i) to[i] += weight * from[i];
}

/// Rows per task.
std::size_t rowChunk(const RowLattice& L) {
  return L.nodeSlots() < 20000 ? std::size_t{1} << 30 : 64;
}

}  // namespace

Eigen::Vector3i coarserCells(const Eigen::Vector3i& cells, const Halved& halved) {
  Eigen::Vector3i n = cells;
  for (int c = 0; c < 3; ++c)
    if (halved[static_cast<std::size_t>(c)]) n[c] = (n[c] + 1) / 2;
  return n;
}

std::vector<double> coarserModuli(const Eigen::Vector3i& cells, const std::vector<double>& E, const Halved& halved) {
  const Eigen::Vector3i n = coarserCells(cells, halved);
  std::vector<double> coarse(
      static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(n.z()), 0.0);
  const double share = 1.0 / ((halved[0] ? 2 : 1) * (halved[1] ? 2 : 1) * (halved[2] ? 2 : 1));
  std::size_t e = 0;
  for (int k = 0; k < cells.z(); ++k)
    for (int j = 0; j < cells.y(); ++j) {
      const int J = halved[1] ? j / 2 : j;
      const int K = halved[2] ? k / 2 : k;
      double* row = coarse.data() +
                    (static_cast<std::size_t>(K) * static_cast<std::size_t>(n.y()) + static_cast<std::size_t>(J)) *
                        static_cast<std::size_t>(n.x());
      for (int i = 0; i < cells.x(); ++i) row[halved[0] ? i / 2 : i] += share * E[e++];
    }
  return coarse;
}

Parents::Parents(int fine, bool halved) {
  if (!halved || fine % 2 == 0) {
    count = 1;
    node[0] = halved ? fine / 2 : fine;
    weight[0] = 1;
  } else {
    count = 2;
    node = {fine / 2, fine / 2 + 1};
    weight = {0.5, 0.5};
  }
}

void restrictTo(const RowLattice& coarse, const RowLattice& fine, const Halved& halved, const float* r_fine,
                float* r_coarse) {
  const auto ny = static_cast<std::size_t>(coarse.cells().y() + 1);
  const auto nz = static_cast<std::size_t>(coarse.cells().z() + 1);
  parallelChunks(ny * nz, rowChunk(fine), [&](std::size_t begin, std::size_t end) {
    std::vector<float> sum;
    for (std::size_t r = begin; r < end; ++r) {
      const int J = static_cast<int>(r % ny);
      const int K = static_cast<int>(r / ny);
      const RowLattice::Row& row = coarse.nodeRow(J, K);
      if (row.length == 0) continue;
      const Children js(J, halved[1], fine.cells().y());
      const Children ks(K, halved[2], fine.cells().z());
      const int first = halved[0] ? 2 * row.begin - 1 : row.begin;
      for (std::size_t c = 0; c < 3; ++c) {
        sum.assign(static_cast<std::size_t>(halved[0] ? 2 * row.length + 1 : row.length), 0.0F);
        for (int b = 0; b < ks.count; ++b)
          for (int a = 0; a < js.count; ++a)
            addOverlap(fine.nodeRow(js.node[static_cast<std::size_t>(a)], ks.node[static_cast<std::size_t>(b)]),
                       r_fine + c * fine.nodeSlots(),
                       js.weight[static_cast<std::size_t>(a)] * ks.weight[static_cast<std::size_t>(b)], first, sum);
        float* out = r_coarse + c * coarse.nodeSlots() + row.offset;
        const float* s = sum.data();
        if (halved[0])
          for (int i = 0; i < row.length; ++i) out[i] = s[2 * i + 1] + 0.5F * (s[2 * i] + s[2 * i + 2]);
        else
          std::copy(sum.begin(), sum.end(), out);
      }
    }
  });
}

void prolongTo(const RowLattice& fine, const RowLattice& coarse, const Halved& halved, const float* x_coarse,
               const float* mask_fine, float* x_fine) {
  const auto ny = static_cast<std::size_t>(fine.cells().y() + 1);
  const auto nz = static_cast<std::size_t>(fine.cells().z() + 1);
  parallelChunks(ny * nz, rowChunk(fine), [&](std::size_t begin, std::size_t end) {
    std::vector<float> line;
    std::vector<float> spread;
    for (std::size_t r = begin; r < end; ++r) {
      const int j = static_cast<int>(r % ny);
      const int k = static_cast<int>(r / ny);
      const RowLattice::Row& row = fine.nodeRow(j, k);
      if (row.length == 0) continue;
      const Parents js(j, halved[1]);
      const Parents ks(k, halved[2]);
      const int first = halved[0] ? row.begin / 2 : row.begin;
      const int size = halved[0] ? row.length / 2 + 2 : row.length;
      for (std::size_t c = 0; c < 3; ++c) {
        line.assign(static_cast<std::size_t>(size), 0.0F);
        for (int b = 0; b < ks.count; ++b)
          for (int a = 0; a < js.count; ++a) {
            const int J = js.node[static_cast<std::size_t>(a)];
            const int K = ks.node[static_cast<std::size_t>(b)];
            addOverlap(
                coarse.nodeRow(J, K), x_coarse + c * coarse.nodeSlots(),
                static_cast<float>(js.weight[static_cast<std::size_t>(a)] * ks.weight[static_cast<std::size_t>(b)]),
                first, line);
          }
        if (halved[0]) {
          spread.resize(2 * line.size() - 1);
          for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            spread[2 * i] = line[i];
            spread[2 * i + 1] = 0.5F * (line[i] + line[i + 1]);
          }
          spread[2 * line.size() - 2] = line.back();
        } else {
          spread = line;
        }
        const float* from = spread.data() + (halved[0] ? row.begin - 2 * first : 0);
        const float* mask = mask_fine + c * fine.nodeSlots() + row.offset;
        float* out = x_fine + c * fine.nodeSlots() + row.offset;
        for (int i = 0; i < row.length; ++i) out[i] = mask[i] != 0 ? from[i] : 0.0F;
      }
    }
  });
}

}  // namespace glisson::mechanics
