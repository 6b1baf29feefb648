// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/multigrid_level.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "mechanics/spectral_bound.h"
#include "mechanics/vector_lanes.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 32768;

/// A fixed node between two coarse ones holds both back like an element of its own: measured best near 1.5 × its
/// diagonal.
constexpr double fixedAsSpring = 1.5;

template <class F>
void forRange(std::size_t n, const F& f) {
  parallelChunks(n, chunk, f);
}

/// Sum over the cells around each node slot of one value per cell slot.
std::vector<double> sumAround(const RowLattice& L, const std::vector<double>& perCell) {
  std::vector<double> sum(L.nodeSlots(), 0.0);
  if (perCell.empty()) return sum;
  for (int k = 0; k < L.cells().z(); ++k)
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length == 0) continue;
      for (int r = 0; r < 4; ++r) {
        double* out = sum.data() + L.slot(row.begin, j + (r & 1), k + (r >> 1));
        const double* value = perCell.data() + row.offset;
        for (int i = 0; i < row.length; ++i) out[i] += value[i];
        for (int i = 0; i < row.length; ++i) out[i + 1] += value[i];
      }
    }
  return sum;
}

/// Calls f(slot, i, j, k) for each node slot.
template <class F>
void forNodes(const RowLattice& L, const F& f) {
  for (int k = 0; k <= L.cells().z(); ++k)
    for (int j = 0; j <= L.cells().y(); ++j) {
      const RowLattice::Row& row = L.nodeRow(j, k);
      for (int i = 0; i < row.length; ++i) f(row.offset + static_cast<std::size_t>(i), row.begin + i, j, k);
    }
}

/// Calls f(coarse slot, weight) for the coarse nodes that a fine node interpolates from.
template <class F>
void forParents(const RowLattice& coarse, const Halved& halved, int i, int j, int k, const F& f) {
  const Parents is(i, halved[0]);
  const Parents js(j, halved[1]);
  const Parents ks(k, halved[2]);
  for (int c = 0; c < ks.count; ++c)
    for (int b = 0; b < js.count; ++b)
      for (int a = 0; a < is.count; ++a) {
        const auto ua = static_cast<std::size_t>(a);
        const auto ub = static_cast<std::size_t>(b);
        const auto uc = static_cast<std::size_t>(c);
        f(coarse.slot(is.node[ua], js.node[ub], ks.node[uc]), is.weight[ua] * js.weight[ub] * ks.weight[uc]);
      }
}

// Loops over plain pointers: the checked operator[] of vectors keeps them from the vector registers.

/// d = a D⁻¹ r; x += d, or x = d.
void chebyshevStart(std::size_t begin, std::size_t end, float a, bool fromZero, const float* inverseDiagonal,
                    const float* r, float* d, float* x) {
  if (fromZero) {
    GLISSON_INDEPENDENT
    for (std::size_t i = begin; i < end; ++i) x[i] = d[i] = a * inverseDiagonal[i] * r[i];
    return;
  }
  GLISSON_INDEPENDENT
  for (std::size_t i = begin; i < end; ++i) {
    d[i] = a * inverseDiagonal[i] * r[i];
    x[i] += d[i];
  }
}

/// r −= y; d = a d + b D⁻¹ r; x += d.
void chebyshevStep(std::size_t begin, std::size_t end, float a, float b, const float* inverseDiagonal, const float* y,
                   float* r, float* d, float* x) {
  GLISSON_INDEPENDENT
  for (std::size_t i = begin; i < end; ++i) {
    r[i] -= y[i];
    d[i] = a * d[i] + b * inverseDiagonal[i] * r[i];
    x[i] += d[i];
  }
}

}  // namespace

MultigridLevel makeLevel(LevelGeometry geometry, HexElement element, double poisson) {
  MultigridLevel level;
  level.geometry = std::move(geometry);
  level.K0 = hexStiffness(element, poisson, level.geometry.h);
  level.M0 = hexMass(level.geometry.h);
  level.exact.lattice = std::make_shared<RowLattice>(level.geometry.cells, level.geometry.E);
  level.exact.blocks = RowBlocks<double>(walshBlocks(level.K0), walshValues(level.M0));
  level.exact.E = cellSlotsOf<double>(*level.exact.lattice, level.geometry.E, 1.0);
  if (!level.geometry.rho.empty()) level.exact.rho = cellSlotsOf<double>(*level.exact.lattice, level.geometry.rho, 1.0);
  return level;
}

void MultigridLevel::finish() {
  const RowLattice& L = *exact.lattice;
  const std::size_t n = L.nodeSlots();
  A.lattice = exact.lattice;
  A.blocks = RowBlocks<float>(walshBlocks(K0), walshValues(M0));
  A.E.assign(exact.E.begin(), exact.E.end());
  A.rho.assign(exact.rho.begin(), exact.rho.end());
  A.fixed = exact.fixed;
  A.springs.clear();
  for (const auto& s : exact.springs) {
    auto& f = A.springs.emplace_back();
    f.slot = s.slot;
    for (std::size_t v = 0; v < 6; ++v) f.k[v] = static_cast<float>(s.k[v]);
  }
  const std::vector<double> around = sumAround(L, exact.E);
  const std::vector<double> massAround = sumAround(L, exact.rho);
  std::vector<double> diagonal(3 * n);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t s = 0; s < n; ++s)
      diagonal[c * n + s] =
          around[s] * K0(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(c)) + massAround[s] * M0(0, 0);
  for (const auto& [slot, k] : exact.springs) {
    diagonal[slot] += k[0];
    diagonal[n + slot] += k[3];
    diagonal[2 * n + slot] += k[5];
  }
  for (const std::size_t f : exact.fixed) diagonal[f] = 0;
  inverseDiagonal.resize(3 * n);
  dofs = 0;
  for (std::size_t i = 0; i < 3 * n; ++i) {
    inverseDiagonal[i] = diagonal[i] > 0 ? static_cast<float>(1 / diagonal[i]) : 0.0F;
    dofs += diagonal[i] > 0;
  }
  for (std::vector<float>* v : {&x, &r, &d, &y}) v->assign(3 * n, 0.0F);
}

void MultigridLevel::bound(bool byCells) {
  lambdaMax = boundOverCells(K0, !A.rho.empty());
  if (!byCells) lambdaMax = std::min(lambdaMax, boundByIteration(A, inverseDiagonal, x, d, y));
  for (std::vector<float>* v : {&x, &d, &y}) std::fill(v->begin(), v->end(), 0.0F);
}

void MultigridLevel::smooth(bool fromZero, int degree, double smoothed, bool keepResidual) {
  const double upper = lambdaMax;
  const double lower = lambdaMax / smoothed;
  const double theta = 0.5 * (upper + lower);
  const double delta = 0.5 * (upper - lower);
  const double sigma = theta / delta;
  double rho = 1 / sigma;
  const auto first = static_cast<float>(1 / theta);
  forRange(x.size(), [&](std::size_t begin, std::size_t end) {
    chebyshevStart(begin, end, first, fromZero, inverseDiagonal.data(), r.data(), d.data(), x.data());
  });
  for (int step = 1; step < degree; ++step) {
    const double next = 1 / (2 * sigma - rho);
    const auto a = static_cast<float>(next * rho);
    const auto b = static_cast<float>(2 * next / delta);
    rho = next;
    A.apply(d.data(), y.data());
    forRange(x.size(), [&](std::size_t begin, std::size_t end) {
      chebyshevStep(begin, end, a, b, inverseDiagonal.data(), y.data(), r.data(), d.data(), x.data());
    });
  }
  if (!keepResidual) return;
  A.apply(d.data(), y.data());
  forRange(x.size(), [rs = r.data(), ys = y.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) rs[i] -= ys[i];
  });
}

MultigridLevel coarsen(MultigridLevel& fine, HexElement element, double poisson) {
  const LevelGeometry& g = fine.geometry;
  double shortest = 0;
  for (int c = 0; c < 3; ++c)
    if (g.cells[c] > 1 && (shortest == 0 || g.h[c] < shortest)) shortest = g.h[c];
  LevelGeometry next;
  next.h = g.h;
  for (int c = 0; c < 3; ++c) {
    fine.halved[static_cast<std::size_t>(c)] = g.cells[c] > 1 && g.h[c] < 1.5 * shortest;
    if (fine.halved[static_cast<std::size_t>(c)]) next.h[c] *= 2;
  }
  next.cells = coarserCells(g.cells, fine.halved);
  next.E = coarserModuli(g.cells, g.E, fine.halved);
  if (!g.rho.empty()) next.rho = coarserModuli(g.cells, g.rho, fine.halved);
  MultigridLevel coarse = makeLevel(std::move(next), element, poisson);

  const RowLattice& F = *fine.exact.lattice;
  const RowLattice& C = *coarse.exact.lattice;
  const std::size_t nf = F.nodeSlots();
  const std::size_t nc = C.nodeSlots();
  const std::vector<double> around = sumAround(F, fine.exact.E);
  const std::vector<double> massAround = sumAround(F, fine.exact.rho);
  std::vector<char> fixed(3 * nf, 0);
  for (const std::size_t f : fine.exact.fixed) fixed[f] = 1;
  std::vector<char> reached(3 * nc, 0);
  std::vector<char> coincident(3 * nc, 0);
  std::vector<std::array<double, 6>> spring(nc, std::array<double, 6>{});
  std::vector<char> sprung(nc, 0);
  std::vector<std::size_t> springOf(nf, fine.exact.springs.size());
  for (std::size_t s = 0; s < fine.exact.springs.size(); ++s) springOf[fine.exact.springs[s].slot] = s;
  forNodes(F, [&](std::size_t slot, int i, int j, int k) {
    if (around[slot] == 0) return;
    forParents(C, fine.halved, i, j, k, [&](std::size_t parent, double weight) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (fixed[c * nf + slot] == 0) {
          reached[c * nc + parent] = 1;
        } else if (weight == 1) {
          coincident[c * nc + parent] = 1;
        } else {
          const double diagonal = around[slot] * fine.K0(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(c)) +
                                  massAround[slot] * fine.M0(0, 0);
          spring[parent][c == 0 ? 0 : c == 1 ? 3 : 5] += fixedAsSpring * weight * diagonal;
          sprung[parent] = 1;
        }
      }
      if (springOf[slot] == fine.exact.springs.size()) return;
      const auto& k6 = fine.exact.springs[springOf[slot]].k;
      for (std::size_t v = 0; v < 6; ++v) spring[parent][v] += weight * k6[v];
      sprung[parent] = 1;
    });
  });
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t s = 0; s < nc; ++s)
      if (coincident[c * nc + s] != 0 || reached[c * nc + s] == 0) coarse.exact.fixed.push_back(c * nc + s);
  for (std::size_t s = 0; s < nc; ++s)
    if (sprung[s] != 0) coarse.exact.springs.push_back({s, spring[s]});
  return coarse;
}

}  // namespace glisson::mechanics
