// SPDX-License-Identifier: GPL-3.0-or-later

// How a level becomes the next coarser one, and the coarsest a dense matrix.
#include <Eigen/LU>
#include <algorithm>

#include "mechanics/contact/solid_level.h"

namespace glisson::mechanics {
namespace {

constexpr double fixedAsSpring = 1.5;  ///< as in the linear multigrid: a clamp between coarse nodes

}  // namespace

Eigen::MatrixXd SolidLevel::dense() const {
  // Unknowns that are there; the rest of the lattice is padding. Nodes three apart share no cell: the columns of all
  // nodes of one colour (i, j, k mod 3) come from one product.
  const RowLattice& L = *lattice;
  const std::size_t n = nodes();
  struct Unknown {
    std::size_t at = 0;
    Eigen::Vector3i node = Eigen::Vector3i::Zero();
  };
  std::array<std::vector<std::size_t>, 81> colours;
  std::vector<Unknown> unknowns;
  for (int k = 0; k <= L.cells().z(); ++k)
    for (int j = 0; j <= L.cells().y(); ++j) {
      const RowLattice::Row& row = L.nodeRow(j, k);
      for (int i = 0; i < row.length; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = c * n + row.offset + static_cast<std::size_t>(i);
          if (!(active[at] > 0)) continue;
          unknowns.push_back({at, {row.begin + i, j, k}});
        }
    }
  std::sort(unknowns.begin(), unknowns.end(), [](const Unknown& a, const Unknown& b) { return a.at < b.at; });
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Eigen::Vector3i colour = unknowns[u].node.unaryExpr([](int i) { return i % 3; });
    colours[27 * (unknowns[u].at / n) + static_cast<std::size_t>(colour.x() + 3 * colour.y() + 9 * colour.z())]
        .push_back(u);
  }
  const auto m = static_cast<Eigen::Index>(unknowns.size()) + 1;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(m, m);
  std::vector<float> in(size(), 0.0F), out(size());
  for (const std::vector<std::size_t>& colour : colours) {
    if (colour.empty()) continue;
    for (const std::size_t u : colour) in[unknowns[u].at] = 1.0F;
    apply(in.data(), out.data(), true);
    for (const std::size_t u : colour) {
      in[unknowns[u].at] = 0.0F;
      for (std::size_t v = 0; v < unknowns.size(); ++v)
        if ((unknowns[u].node - unknowns[v].node).cwiseAbs().maxCoeff() <= 1)
          K(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(u)) = static_cast<double>(out[unknowns[v].at]);
    }
  }
  if (travels_) {
    in[3 * n] = 1.0F;
    apply(in.data(), out.data(), true);
    for (std::size_t v = 0; v < unknowns.size(); ++v)
      K(m - 1, static_cast<Eigen::Index>(v)) = K(static_cast<Eigen::Index>(v), m - 1) =
          static_cast<double>(out[unknowns[v].at]);
    K(m - 1, m - 1) = static_cast<double>(out[3 * n]);
  }
  if (!(K(m - 1, m - 1) > 0)) {
    K.row(m - 1).setZero();
    K.col(m - 1).setZero();
    K(m - 1, m - 1) = 1;
  }
  return 0.5 * (K + K.transpose());
}

SolidLevel SolidLevel::coarser() {
  double shortest = 0;
  for (int c = 0; c < 3; ++c)
    if (moduli.cells[c] > 1 && (shortest == 0 || moduli.h_m[c] < shortest)) shortest = moduli.h_m[c];
  CellModuli next;
  next.h_m = moduli.h_m;
  for (int c = 0; c < 3; ++c) {
    const auto axis = static_cast<std::size_t>(c);
    halved[axis] = moduli.cells[c] > 1 && moduli.h_m[c] < 1.5 * shortest;
    if (halved[axis]) next.h_m[c] *= 2;
  }
  next.cells = coarserCells(moduli.cells, halved);
  next.mu_Pa = coarserModuli(moduli.cells, moduli.mu_Pa, halved);
  next.lambda_Pa = coarserModuli(moduli.cells, moduli.lambda_Pa, halved);
  SolidLevel coarse(std::move(next));

  const RowLattice& F = *lattice;
  const RowLattice& C = *coarse.lattice;
  const std::size_t nf = nodes(), nc = coarse.nodes();
  std::vector<std::size_t> fixedAt(3 * nf, fixed.size());
  for (std::size_t f = 0; f < fixed.size(); ++f) fixedAt[fixed[f]] = f;
  std::vector<std::size_t> springAt(nf, springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s) springAt[springs[s].slot] = s;
  std::vector<char> reached(3 * nc, 0), coincident(3 * nc, 0), sprung(nc, 0);
  std::vector<std::array<double, 6>> spring(nc, std::array<double, 6>{});
  forParentsOfNodes(F, C, halved, [&](std::size_t slot, std::size_t parent, double weight) {
    if (there[slot] == 0) return;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t f = fixedAt[c * nf + slot];
      if (f == fixed.size()) {
        reached[c * nc + parent] = 1;
      } else if (weight == 1) {
        coincident[c * nc + parent] = 1;
      } else if (f < clampedDiagonal_.size()) {
        spring[parent][c == 0 ? 0 : c == 1 ? 3 : 5] += fixedAsSpring * weight * clampedDiagonal_[f];
        sprung[parent] = 1;
      }
    }
    if (springAt[slot] == springs.size()) return;
    for (std::size_t v = 0; v < 6; ++v) spring[parent][v] += weight * springs[springAt[slot]].k[v];
    sprung[parent] = 1;
  });
  for (std::size_t i = 0; i < 3 * nc; ++i) {
    if (coincident[i] == 0 && reached[i] != 0) continue;
    coarse.active[i] = 0;
    coarse.fixed.push_back(i);
  }
  for (std::size_t s = 0; s < nc; ++s)
    if (sprung[s] != 0) coarse.springs.push_back({s, spring[s]});
  return coarse;
}

}  // namespace glisson::mechanics
