// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/solid_hierarchy.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 32768;
constexpr int coarsestNodes = 120;

double dotOf(const std::vector<float>& a, const std::vector<float>& b) {
  return parallelSum(a.size(), chunk, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t i = begin; i < end; ++i) s += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return s;
  });
}

int freeNodes(const SolidLevel& level) {
  int count = 0;
  const std::size_t n = level.nodes();
  for (std::size_t i = 0; i < n; ++i)
    count += level.active[i] > 0 || level.active[n + i] > 0 || level.active[2 * n + i] > 0 ? 1 : 0;
  return count;
}

}  // namespace

SolidHierarchy::SolidHierarchy(SolidLevel finest) {
  levels_.push_back(std::move(finest));
  while (freeNodes(levels_.back()) > coarsestNodes && levels_.back().moduli.cells.maxCoeff() > 1) {
    SolidLevel& last = levels_.back();
    // A linearisation at rest gives the diagonal that clamped nodes hand on to coarser levels.
    const std::vector<double> rest(3 * last.nodes(), 0.0);
    last.linearise(SolidLaw::Linear, rest.data(), {}, false, Eigen::Vector3d::Zero());
    SolidLevel next = last.coarser();
    levels_.push_back(std::move(next));
  }
  const SolidLevel& last = levels_.back();
  for (std::size_t i = 0; i < 3 * last.nodes(); ++i)
    if (last.active[i] > 0) coarsestDofs_.push_back(i);
  coarsestDofs_.push_back(3 * last.nodes());
}

void SolidHierarchy::setPoints(const std::vector<Eigen::Vector3i>& cells,
                               const std::vector<Eigen::Vector3d>& places_m) {
  std::vector<Eigen::Vector3i> at = cells;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    SolidLevel& level = levels_[l];
    level.points.clear();
    level.points.reserve(at.size());
    for (std::size_t p = 0; p < at.size(); ++p) level.points.push_back(level.carry(at[p], places_m[p]));
    for (Eigen::Vector3i& c : at)
      for (int axis = 0; axis < 3; ++axis)
        if (level.halved[static_cast<std::size_t>(axis)]) c[axis] /= 2;
  }
}

void SolidHierarchy::setSkin(const std::vector<SkinSample>& samples, const Skin& skin) {
  std::vector<SkinSample> at = samples;
  for (SolidLevel& level : levels_) {
    level.membrane = Membrane(*level.lattice, level.moduli.h_m, at, skin);
    for (SkinSample& s : at)
      for (int axis = 0; axis < 3; ++axis)
        if (level.halved[static_cast<std::size_t>(axis)]) s.cell[axis] /= 2;
  }
}

bool SolidHierarchy::linearise(std::size_t top, SolidLaw law, const double* u,
                               const std::vector<PointStiffness>& contact, bool travels, const Eigen::Vector3d& hoist) {
  levels_[top].followers = followers_;
  levels_[top].linearise(law, u, contact, travels, hoist);
  std::vector<double> at(u, u + 3 * levels_[top].nodes());
  for (std::size_t l = top; l + 1 < levels_.size(); ++l) {
    const SolidLevel& fine = levels_[l];
    SolidLevel& coarse = levels_[l + 1];
    const std::size_t nf = fine.nodes(), nc = coarse.nodes();
    if (law != SolidLaw::Linear) {
      std::vector<double> sum(3 * nc, 0.0), weight(nc, 0.0);
      forParentsOfNodes(*fine.lattice, *coarse.lattice, fine.halved,
                        [&](std::size_t slot, std::size_t parent, double w) {
                          if (!fine.there[slot]) return;
                          weight[parent] += w;
                          for (std::size_t c = 0; c < 3; ++c) sum[c * nc + parent] += w * at[c * nf + slot];
                        });
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < nc; ++i)
          if (weight[i] > 0) sum[c * nc + i] /= weight[i];
      at = std::move(sum);
    } else {
      at.assign(3 * nc, 0.0);
    }
    coarse.linearise(law, at.data(), contact, travels, hoist);
  }
  return factorise();
}

bool SolidHierarchy::factorise() {
  Eigen::MatrixXd K = levels_.back().dense();
  coarsest_.compute(K);
  for (int tries = 0; coarsest_.info() != Eigen::Success && tries < 3; ++tries) {
    // The positive part may miss being positive by rounding, or where cells are far from rest.
    K.diagonal() *= 1.01 + 0.1 * tries;
    coarsest_.compute(K);
  }
  return coarsest_.info() == Eigen::Success;
}

void SolidHierarchy::cycle(std::size_t l) {
  SolidLevel& level = levels_[l];
  if (l + 1 == levels_.size()) {
    Eigen::VectorXd b(static_cast<Eigen::Index>(coarsestDofs_.size()));
    for (std::size_t i = 0; i < coarsestDofs_.size(); ++i)
      b[static_cast<Eigen::Index>(i)] = static_cast<double>(level.r[coarsestDofs_[i]]);
    coarsest_.solveInPlace(b);
    std::fill(level.x.begin(), level.x.end(), 0.0F);
    for (std::size_t i = 0; i < coarsestDofs_.size(); ++i)
      level.x[coarsestDofs_[i]] = static_cast<float>(b[static_cast<Eigen::Index>(i)]);
    return;
  }
  SolidLevel& next = levels_[l + 1];
  const std::size_t n = level.nodes(), nc = next.nodes();
  level.smooth(true, true);
  restrictTo(*next.lattice, *level.lattice, level.halved, level.r.data(), next.r.data());
  next.r[3 * nc] = level.r[3 * n];
  for (std::size_t i = 0; i < 3 * nc; ++i) next.r[i] *= next.active[i];
  cycle(l + 1);
  prolongTo(*level.lattice, *next.lattice, level.halved, next.x.data(), level.active.data(), level.d.data());
  level.d[3 * n] = next.x[3 * nc];
  level.apply(level.d.data(), level.y.data(), true);
  parallelChunks(level.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      level.x[i] += level.d[i];
      level.r[i] -= level.y[i];
    }
  });
  level.smooth(false, false);
}

bool SolidHierarchy::precondition(std::size_t top, const std::vector<float>& r, std::vector<float>& z, double& rz) {
  SolidLevel& level = levels_[top];
  for (int tries = 0; tries < 4; ++tries) {
    level.r = r;
    cycle(top);
    z = level.x;
    rz = dotOf(r, z);
    if (rz > 0) return true;
    // Smoothers that overshoot: λmax was too small somewhere.
    for (std::size_t l = top; l < levels_.size(); ++l) levels_[l].raiseLambda(1.4F);
  }
  return false;
}

TangentSolve SolidHierarchy::solve(std::size_t top, const std::vector<double>& b, std::vector<double>& x,
                                   double tolerance, int limit, bool positive) {
  const SolidLevel& level = levels_[top];
  const std::size_t n = level.size();
  double largest = 0;
  for (const double v : b) largest = std::max(largest, std::abs(v));
  TangentSolve result;
  x.assign(n, 0.0);
  if (!(largest > 0)) {
    result.outcome = TangentOutcome::Converged;
    return result;
  }
  std::vector<float> r(n), z(n), p(n, 0.0F), q(n), sum(n, 0.0F), last;
  for (std::size_t i = 0; i < n; ++i) r[i] = static_cast<float>(b[i] / largest);
  const double goal = tolerance * std::sqrt(dotOf(r, r));
  double rz = 0, before = 1;
  for (result.iterations = 0; result.iterations < limit;) {
    if (!precondition(top, r, z, rz)) {
      result.outcome = TangentOutcome::Indefinite;
      break;
    }
    // Flexible: the cycle runs in float and is only nearly linear.
    const double beta = result.iterations == 0 ? 0 : (rz - dotOf(last, z)) / before;
    parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) {
      const auto f = static_cast<float>(beta);
      for (std::size_t i = begin; i < end; ++i) p[i] = z[i] + f * p[i];
    });
    level.apply(p.data(), q.data(), positive);
    const double curvature = dotOf(p, q);
    ++result.iterations;
    if (!(curvature > 0)) {
      result.outcome = TangentOutcome::Indefinite;
      if (result.iterations == 1) sum = p;
      break;
    }
    const auto alpha = static_cast<float>(rz / curvature);
    last = r;
    parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        sum[i] += alpha * p[i];
        r[i] -= alpha * q[i];
      }
    });
    before = rz;
    if (std::sqrt(dotOf(r, r)) <= goal) {
      result.outcome = TangentOutcome::Converged;
      break;
    }
  }
  for (std::size_t i = 0; i < n; ++i) x[i] = largest * static_cast<double>(sum[i]);
  return result;
}

TangentSolve SolidHierarchy::solveUnsymmetric(std::size_t top, const std::vector<double>& b, std::vector<double>& x,
                                              double tolerance, int limit) {
  constexpr int most = 40;  // vectors kept until it starts anew
  const SolidLevel& level = levels_[top];
  const std::size_t n = level.size();
  double largest = 0;
  for (const double v : b) largest = std::max(largest, std::abs(v));
  TangentSolve result;
  x.assign(n, 0.0);
  std::vector<float> rhs(n), r, sum(n, 0.0F), w(n);
  if (largest > 0)
    for (std::size_t i = 0; i < n; ++i) rhs[i] = static_cast<float>(b[i] / largest);
  r = rhs;
  const double goal = tolerance * std::sqrt(dotOf(r, r));
  double size = std::sqrt(dotOf(r, r));
  const auto add = [&](const std::vector<float>& v, double factor, std::vector<float>& to) {
    parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) {
      const auto f = static_cast<float>(factor);
      for (std::size_t i = begin; i < end; ++i) to[i] += f * v[i];
    });
  };
  while (size > goal && result.iterations < limit) {
    // Flexible, from the right: the cycle runs in float and is only nearly linear.
    std::vector<std::vector<float>> basis(1, std::vector<float>(n, 0.0F)), conditioned;
    add(r, 1 / size, basis[0]);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(most + 1, most);
    Eigen::VectorXd y;
    for (int j = 0; j < most && result.iterations < limit; ++j) {
      ++result.iterations;
      double rz = 0;
      precondition(top, basis.back(), conditioned.emplace_back(), rz);
      level.apply(conditioned.back().data(), w.data(), false);
      for (int i = 0; i <= j; ++i) {
        H(i, j) = dotOf(basis[static_cast<std::size_t>(i)], w);
        add(basis[static_cast<std::size_t>(i)], -H(i, j), w);
      }
      H(j + 1, j) = std::sqrt(dotOf(w, w));
      const Eigen::VectorXd first = size * Eigen::VectorXd::Unit(j + 2, 0);
      const Eigen::MatrixXd Hj = H.topLeftCorner(j + 2, j + 1);
      y = Hj.colPivHouseholderQr().solve(first);
      if (!(H(j + 1, j) > 0) || (first - Hj * y).norm() <= goal) break;
      basis.emplace_back(n, 0.0F);
      add(w, 1 / H(j + 1, j), basis.back());
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(y.size()); ++i)
      add(conditioned[i], y[static_cast<Eigen::Index>(i)], sum);
    level.apply(sum.data(), w.data(), false);
    r = rhs;
    add(w, -1, r);
    const double before = size;
    size = std::sqrt(dotOf(r, r));
    if (!(size < 0.999 * before)) break;
  }
  if (size <= 1.5 * goal) result.outcome = TangentOutcome::Converged;
  for (std::size_t i = 0; i < n; ++i) x[i] = largest * static_cast<double>(sum[i]);
  return result;
}

std::vector<double> SolidHierarchy::prolonged(std::size_t l, const std::vector<double>& coarse) const {
  const SolidLevel& fine = levels_[l];
  const SolidLevel& from = levels_[l + 1];
  const std::size_t nf = fine.nodes(), nc = from.nodes();
  std::vector<double> u(3 * nf, 0.0);
  forParentsOfNodes(*fine.lattice, *from.lattice, fine.halved, [&](std::size_t slot, std::size_t parent, double w) {
    for (std::size_t c = 0; c < 3; ++c)
      if (fine.active[c * nf + slot] > 0) u[c * nf + slot] += w * coarse[c * nc + parent];
  });
  return u;
}

}  // namespace glisson::mechanics
