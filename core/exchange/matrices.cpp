// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/detail/matrices.h"

#include <map>
#include <ostream>

#include "exchange/text_file.h"
#include "mechanics/hex_element.h"

namespace glisson::exchange {
namespace {

/// Blocks of one row, by column node, diagonal last. Columns above the diagonal are left out.
using Row = std::map<int, Eigen::Matrix3d>;

/// Cells that touch a node, with the node's corner number in each.
struct Touching {
  explicit Touching(const mechanics::VoxelMesh& mesh) : first(static_cast<std::size_t>(mesh.nodeCount()) + 1, 0) {
    for (int c = 0; c < mesh.cellCount(); ++c)
      for (const int node : mesh.nodesOf(c)) ++first[static_cast<std::size_t>(node) + 1];
    for (std::size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
    cell.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (int c = 0; c < mesh.cellCount(); ++c)
      for (const int node : mesh.nodesOf(c)) cell[next[static_cast<std::size_t>(node)]++] = c;
  }
  std::vector<std::size_t> first;
  std::vector<int> cell;
};

/// Three scalar rows of the lower triangle. Zero entries stay where they belong to the pattern.
void writeRow(std::ostream& out, int node, const Row& row) {
  for (int a = 0; a < 3; ++a)
    for (const auto& [column, block] : row)
      for (int b = 0; b < (column == node ? a + 1 : 3); ++b)
        out << 3 * node + a + 1 << ' ' << 3 * column + b + 1 << ' ' << shortest(block(a, b)) << '\n';
}

std::size_t entries(const mechanics::VoxelMesh& mesh, const Touching& touching) {
  std::size_t blocks = 0;
  std::map<int, char> seen;
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    seen.clear();
    for (std::size_t t = touching.first[static_cast<std::size_t>(n)];
         t < touching.first[static_cast<std::size_t>(n) + 1]; ++t)
      for (const int other : mesh.nodesOf(touching.cell[t]))
        if (other < n) seen[other] = 1;
    blocks += seen.size();
  }
  return 9 * blocks + 6 * static_cast<std::size_t>(mesh.nodeCount());
}

void header(std::ostream& out, const char* what, int nodes, std::size_t count) {
  out << "%%MatrixMarket matrix coordinate real symmetric\n"
      << "% " << what << "\n"
      << "% unknown 3 n + a + 1: displacement of node n (from 0, as in the meshes) along patient axis a (0 L, 1 P, 2 "
         "S)\n"
      << 3 * nodes << ' ' << 3 * nodes << ' ' << count << '\n';
}

}  // namespace

std::vector<std::filesystem::path> writeMatrices(const std::filesystem::path& folder, const retraction::Body& body,
                                                 mechanics::HexElement element) {
  const mechanics::VoxelMesh& mesh = body.mesh();
  const mechanics::VoxelBody& voxels = body.voxels();
  const Touching touching(mesh);
  const std::size_t count = entries(mesh, touching);
  const mechanics::HexMatrix K0 = mechanics::hexStiffness(element, voxels.poisson, mesh.h_m());
  const Eigen::Matrix<double, 8, 8> M0 = voxels.density_kg_m3 * mechanics::hexMass(mesh.h_m());
  Eigen::Matrix3d toLps;
  for (int a = 0; a < 3; ++a) toLps.col(a) = body.vectorToLps(Eigen::Vector3d::Unit(a));
  std::array<std::array<Eigen::Matrix3d, 8>, 8> stiffness;
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < 8; ++b)
      stiffness[a][b] = toLps * K0.block<3, 3>(3 * static_cast<Eigen::Index>(a), 3 * static_cast<Eigen::Index>(b)) *
                        toLps.transpose();

  // One pass per matrix: a row is summed over the cells round its node, written, and forgotten.
  const auto write = [&](const char* name, const char* what, const auto& add) {
    writeTextFile(folder / name, [&](std::ostream& out) {
      header(out, what, mesh.nodeCount(), count);
      Row row;
      for (int n = 0; n < mesh.nodeCount(); ++n) {
        row.clear();
        for (std::size_t t = touching.first[static_cast<std::size_t>(n)];
             t < touching.first[static_cast<std::size_t>(n) + 1]; ++t) {
          const std::array<int, 8> nodes = mesh.nodesOf(touching.cell[t]);
          const Eigen::Vector3i at = mesh.cellOf(touching.cell[t]);
          const double E_Pa = voxels.E_Pa[voxels.cell(at.x(), at.y(), at.z())];
          std::size_t own = 0;
          while (nodes[own] != n) ++own;
          for (std::size_t b = 0; b < 8; ++b)
            if (nodes[b] <= n) add(row.try_emplace(nodes[b], Eigen::Matrix3d::Zero()).first->second, E_Pa, own, b);
        }
        writeRow(out, n, row);
      }
    });
    return folder / name;
  };
  return {write("K.mtx", "stiffness of the body without its supports, N/m (= mN/mm)",
                [&](Eigen::Matrix3d& block, double E_Pa, std::size_t a, std::size_t b) {
                  block += E_Pa * stiffness[a][b];
                }),
          write("M.mtx", "consistent mass, kg", [&](Eigen::Matrix3d& block, double, std::size_t a, std::size_t b) {
            block.diagonal().array() += M0(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
          })};
}

std::vector<std::filesystem::path> writeSpringMatrix(const std::filesystem::path& folder, const retraction::Body& body,
                                                     const mechanics::Supports& supports) {
  Eigen::Matrix3d toLps;
  for (int a = 0; a < 3; ++a) toLps.col(a) = body.vectorToLps(Eigen::Vector3d::Unit(a));
  Row perNode;
  for (const mechanics::Spring& s : supports.springs)
    perNode.try_emplace(s.node, Eigen::Matrix3d::Zero()).first->second += toLps * s.k_N_m * toLps.transpose();
  if (perNode.empty()) return {};
  writeTextFile(folder / "springs.mtx", [&](std::ostream& out) {
    header(out, "spring supports, N/m (= mN/mm)", body.mesh().nodeCount(), 6 * perNode.size());
    for (const auto& [node, k] : perNode) writeRow(out, node, {{node, k}});
  });
  return {folder / "springs.mtx"};
}

}  // namespace glisson::exchange
