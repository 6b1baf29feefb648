// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/solid_level.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/contact/smoother_kernel.h"
#include "mechanics/lattice_operator.h"
#include "mechanics/row_sweep.h"
#include "mechanics/vector_lanes.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 32768;
constexpr int degree = 3;        ///< of the smoother, before and after a coarse correction
constexpr double smoothed = 16;  ///< it acts on [λmax / smoothed, λmax]
constexpr double safety = 1.15;  ///< on the estimate of λmax

template <class F>
void forRange(std::size_t n, const F& f) {
  parallelChunks(n, chunk, f);
}

template <class In, class Out>
CellRow<In, Out> rowOf(const RowLattice& L, int j, int k, const In* x, Out* y) {
  CellRow<In, Out> row;
  const RowLattice::Row& cells = L.cellRow(j, k);
  const std::size_t n = L.nodeSlots();
  for (int r = 0; r < 4; ++r) {
    const std::size_t s = L.slot(cells.begin, j + (r & 1), k + (r >> 1));
    for (std::size_t c = 0; c < 3; ++c) {
      row.in[r][c] = x + c * n + s;
      row.out[r][c] = y == nullptr ? nullptr : y + c * n + s;
    }
  }
  row.n = static_cast<std::size_t>(cells.length);
  return row;
}

template <class T>
auto clearer(const RowLattice& L, T* y) {
  return [&L, y](int from, int to) {
    const std::size_t n = L.nodeSlots(), a = L.layerBegin(from), b = L.layerBegin(to);
    for (std::size_t c = 0; c < 3; ++c) std::fill(y + c * n + a, y + c * n + b, T{0});
  };
}

/// Nodes that a filled cell touches.
std::vector<char> nodesThere(const RowLattice& L, const std::vector<double>& mu) {
  std::vector<char> there(L.nodeSlots(), 0);
  for (int k = 0; k < L.cells().z(); ++k)
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length == 0) continue;
      for (int r = 0; r < 4; ++r) {
        const std::size_t s = L.slot(row.begin, j + (r & 1), k + (r >> 1));
        for (std::size_t i = 0; i < static_cast<std::size_t>(row.length); ++i)
          if (mu[row.offset + i] > 0) there[s + i] = there[s + i + 1] = 1;
      }
    }
  return there;
}

double dotOf(const std::vector<float>& a, const std::vector<float>& b) {
  return parallelSum(a.size(), chunk, [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t i = begin; i < end; ++i) s += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return s;
  });
}

}  // namespace

SolidLevel::SolidLevel(CellModuli m) : moduli(std::move(m)), modes(moduli.h_m) {
  lattice = std::make_shared<RowLattice>(moduli.cells, moduli.mu_Pa);
  const double volume = moduli.h_m.prod();
  mu = cellSlotsOf<double>(*lattice, moduli.mu_Pa, volume);
  lambda = cellSlotsOf<double>(*lattice, moduli.lambda_Pa, volume);
  there = nodesThere(*lattice, mu);
  active.assign(3 * nodes(), 0.0F);
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = there[i % nodes()] != 0 ? 1.0F : 0.0F;
  state_.assign(TangentArrays::count * lattice->cellSlots(), 0.0F);
  block_.assign(6 * nodes(), 0.0F);
  for (std::vector<float>* v : {&x, &r, &d, &y}) v->assign(size(), 0.0F);
}

CarriedPoint SolidLevel::carry(const Eigen::Vector3i& cell, const Eigen::Vector3d& p_m) const {
  CarriedPoint point;
  const Eigen::Vector3d xi = p_m.cwiseQuotient(moduli.h_m) - cell.cast<double>();
  for (int row = 0; row < 4; ++row) {
    const int b = row & 1, c = row >> 1;
    point.slot[static_cast<std::size_t>(row)] =
        static_cast<std::uint32_t>(lattice->slot(cell.x(), cell.y() + b, cell.z() + c));
    const double w = (b != 0 ? xi.y() : 1 - xi.y()) * (c != 0 ? xi.z() : 1 - xi.z());
    point.weight[static_cast<std::size_t>(2 * row)] = static_cast<float>(w * (1 - xi.x()));
    point.weight[static_cast<std::size_t>(2 * row + 1)] = static_cast<float>(w * xi.x());
  }
  return point;
}

bool SolidLevel::forces(SolidLaw law, const double* u, double& energy, double* gradient) const {
  const RowLattice& L = *lattice;
  std::vector<double> perLayer(static_cast<std::size_t>(L.cells().z()), 0.0);
  std::vector<char> fine(perLayer.size(), 1);
  sweepLayers(L, clearer(L, gradient), [&](int k) {
    bool good = true;
    double sum = 0;
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length == 0) continue;
      sum += addCellForces(law, modes, rowOf(L, j, k, u, gradient), mu.data() + row.offset, lambda.data() + row.offset,
                           good);
    }
    perLayer[static_cast<std::size_t>(k)] = sum;
    fine[static_cast<std::size_t>(k)] = good ? 1 : 0;
  });
  energy = 0;
  for (const double e : perLayer) energy += e;
  const std::size_t n = nodes();
  for (const SlotSpring& s : springs) {
    const Eigen::Vector3d v(u[s.slot], u[n + s.slot], u[2 * n + s.slot]);
    const Eigen::Vector3d f(s.k[0] * v.x() + s.k[1] * v.y() + s.k[2] * v.z(),
                            s.k[1] * v.x() + s.k[3] * v.y() + s.k[4] * v.z(),
                            s.k[2] * v.x() + s.k[4] * v.y() + s.k[5] * v.z());
    energy += 0.5 * v.dot(f);
    for (std::size_t c = 0; c < 3; ++c) gradient[c * n + s.slot] += f[static_cast<Eigen::Index>(c)];
  }
  energy += membrane.addForces(u, n, gradient);
  return std::all_of(fine.begin(), fine.end(), [](char g) { return g != 0; }) && std::isfinite(energy);
}

double SolidLevel::smallestVolumeRatio(const double* u) const {
  const RowLattice& L = *lattice;
  double smallest = 1;
  for (int k = 0; k < L.cells().z(); ++k)
    for (int j = 0; j < L.cells().y(); ++j)
      if (L.cellRow(j, k).length > 0)
        smallest = mechanics::smallestVolumeRatio(modes, rowOf<double, double>(L, j, k, u, nullptr),
                                                  mu.data() + L.cellRow(j, k).offset, smallest);
  return smallest;
}

void SolidLevel::linearise(SolidLaw law, const double* u, const std::vector<PointStiffness>& contact, bool travels,
                           const Eigen::Vector3d& hoist) {
  const RowLattice& L = *lattice;
  parallelChunks(static_cast<std::size_t>(L.cells().z()), 2, [&](std::size_t begin, std::size_t end) {
    for (auto k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < L.cells().y(); ++j) {
        const RowLattice::Row& row = L.cellRow(j, k);
        if (row.length == 0) continue;
        lineariseCells(law, modes, rowOf<double, double>(L, j, k, u, nullptr), mu.data() + row.offset,
                       lambda.data() + row.offset, state_.data() + TangentArrays::count * row.offset);
      }
  });
  membrane.linearise(u, nodes());
  contact_ = contact;
  travels_ = travels;
  hoist_ = hoist.cast<float>();
  makeBlocks();
  estimateLambda();
}

void SolidLevel::makeBlocks() {
  const RowLattice& L = *lattice;
  const std::size_t n = nodes();
  std::fill(block_.begin(), block_.end(), 0.0F);
  const auto none = [](int, int) {};
  sweepLayers(L, none, [&](int k) {
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length == 0) continue;
      float* out[4];
      for (int q = 0; q < 4; ++q) out[q] = block_.data() + L.slot(row.begin, j + (q & 1), k + (q >> 1));
      addCellDiagonal(modes, out, n, static_cast<std::size_t>(row.length),
                      state_.data() + TangentArrays::count * row.offset);
    }
  });
  for (const SlotSpring& s : springs)
    for (std::size_t v = 0; v < 6; ++v) block_[v * n + s.slot] += static_cast<float>(s.k[v]);
  membrane.addDiagonal(n, block_.data());
  double travel = 0;
  for (const PointStiffness& c : contact_) {
    if (travels_ && c.bar) travel += static_cast<double>(hoist_.dot(c.positive * hoist_));
    const CarriedPoint& p = points[c.point];
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t i = 0; i < 2; ++i) {
        const float w = p.weight[2 * row + i];
        float* b = block_.data() + p.slot[row] + i;
        std::size_t entry = 0;
        for (int k = 0; k < 3; ++k)
          for (int l = k; l < 3; ++l) b[(entry++) * n] += w * w * c.positive(k, l);
      }
  }
  inverseTravel_ = travel > 0 ? static_cast<float>(1 / travel) : 0.0F;
  clampedDiagonal_.clear();
  for (const std::size_t f : fixed) {
    const std::size_t c = f / n;
    clampedDiagonal_.push_back(static_cast<double>(block_[(c == 0 ? 0 : c == 1 ? 3 : 5) * n + f % n]));
  }
  forRange(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Matrix3d B;
      B << block_[i], block_[n + i], block_[2 * n + i], block_[n + i], block_[3 * n + i], block_[4 * n + i],
          block_[2 * n + i], block_[4 * n + i], block_[5 * n + i];
      bool any = false;
      for (int c = 0; c < 3; ++c) {
        if (active[static_cast<std::size_t>(c) * n + i] > 0) {
          any = true;
          continue;
        }
        B.row(c).setZero();
        B.col(c).setZero();
        B(c, c) = 1;
      }
      Eigen::Matrix3d inverse = any ? Eigen::Matrix3d(B.inverse()) : Eigen::Matrix3d::Zero();
      for (int c = 0; c < 3; ++c)
        if (!(active[static_cast<std::size_t>(c) * n + i] > 0)) inverse(c, c) = 0;
      std::size_t entry = 0;
      for (int k = 0; k < 3; ++k)
        for (int l = k; l < 3; ++l) block_[(entry++) * n + i] = static_cast<float>(inverse(k, l));
    }
  });
}

template <class T>
void SolidLevel::applyPoints(const T* in, T* out, bool positive) const {
  const std::size_t n = nodes();
  const T s = travels_ ? in[3 * n] : T{0};
  T travel = 0;
  for (const PointStiffness& c : contact_) {
    Eigen::Matrix<T, 3, 1> v = points[c.point].at(in, n);
    if (c.bar) v -= s * hoist_.cast<T>();
    const Eigen::Matrix<T, 3, 1> f = (positive ? c.positive : c.exact).template cast<T>() * v;
    points[c.point].add(f, out, n);
    if (c.bar) travel -= hoist_.cast<T>().dot(f);
  }
  out[3 * n] = travels_ ? travel : T{0};
  if (positive) return;
  for (const FollowerStiffness& t : followers) {
    Eigen::Matrix<T, 3, 1> f = Eigen::Matrix<T, 3, 1>::Zero();
    for (std::size_t j = 0; j < 3; ++j) f += t.share[j].template cast<T>() * points[t.point[j]].at(in, n);
    for (const std::uint32_t p : t.point) points[p].add(f, out, n);
  }
}

void SolidLevel::apply(const float* in, float* out, bool positive) const {
  const RowLattice& L = *lattice;
  const std::size_t n = nodes();
  sweepLayers(L, clearer(L, out), [&](int k) {
    for (int j = 0; j < L.cells().y(); ++j) {
      const RowLattice::Row& row = L.cellRow(j, k);
      if (row.length > 0)
        addCellTangent(modes, rowOf(L, j, k, in, out), state_.data() + TangentArrays::count * row.offset, positive);
    }
  });
  for (const SlotSpring& s : springs) {
    const float a = in[s.slot], b = in[n + s.slot], c = in[2 * n + s.slot];
    const auto k = [&](std::size_t v) { return static_cast<float>(s.k[v]); };
    out[s.slot] += k(0) * a + k(1) * b + k(2) * c;
    out[n + s.slot] += k(1) * a + k(3) * b + k(4) * c;
    out[2 * n + s.slot] += k(2) * a + k(4) * b + k(5) * c;
  }
  membrane.addTangent(in, n, out);
  applyPoints(in, out, positive);
  for (const std::size_t f : fixed) out[f] = 0;
}

void SolidLevel::applyInverseBlocks(const float* in, float* out) const {
  const std::size_t n = nodes();
  const float* b = block_.data();
  forRange(n, [&](std::size_t begin, std::size_t end) {
    GLISSON_INDEPENDENT
    for (std::size_t i = begin; i < end; ++i) {
      const float p = in[i], q = in[n + i], s = in[2 * n + i];
      out[i] = b[i] * p + b[n + i] * q + b[2 * n + i] * s;
      out[n + i] = b[n + i] * p + b[3 * n + i] * q + b[4 * n + i] * s;
      out[2 * n + i] = b[2 * n + i] * p + b[4 * n + i] * q + b[5 * n + i] * s;
    }
  });
  out[3 * n] = travels_ ? inverseTravel_ * in[3 * n] : 0.0F;
}

void SolidLevel::estimateLambda() {
  // Two steps from the last eigenvector: it changes little from one linearisation to the next.
  int steps = 2;
  if (power_.empty()) {
    steps = 10;
    power_.assign(size(), 0.0F);
    Random random(17);
    for (std::size_t i = 0; i < 3 * nodes(); ++i)
      if (active[i] > 0) power_[i] = static_cast<float>(random.uniform(-1, 1));
  }
  power_[3 * nodes()] = travels_ && inverseTravel_ > 0 ? power_[3 * nodes()] + 0.01F : 0.0F;
  double estimate = 0;
  for (int step = 0; step < steps; ++step) {
    apply(power_.data(), y.data(), true);
    applyInverseBlocks(y.data(), d.data());
    // Ratio of norms: below λmax, and rising to it.
    const double before = dotOf(power_, power_), after = dotOf(d, d);
    if (!(before > 0) || !(after > 0)) break;
    estimate = std::sqrt(after / before);
    const auto scale = static_cast<float>(1 / std::sqrt(after));
    for (std::size_t i = 0; i < d.size(); ++i) power_[i] = scale * d[i];
  }
  lambdaMax_ = static_cast<float>(safety * std::max(estimate, 1.0));
}

void SolidLevel::smoothStep(float keep, float gain, bool first, bool fromZero) {
  const std::size_t n = nodes();
  const SmootherFields fields{n, block_.data(), y.data(), r.data(), d.data(), x.data()};
  forRange(n,
           [&](std::size_t begin, std::size_t end) { smoothNodes(fields, begin, end, keep, gain, first, fromZero); });
  float &rest = r[3 * n], &along = d[3 * n], &travel = x[3 * n];
  if (!first) rest -= y[3 * n];
  along = (first ? 0.0F : keep * along) + gain * (travels_ ? inverseTravel_ * rest : 0.0F);
  travel = fromZero ? along : travel + along;
}

void SolidLevel::smooth(bool fromZero, bool keepResidual) {
  const double upper = static_cast<double>(lambdaMax_), lower = upper / smoothed;
  const double theta = 0.5 * (upper + lower), delta = 0.5 * (upper - lower), sigma = theta / delta;
  double rho = 1 / sigma;
  smoothStep(0, static_cast<float>(1 / theta), true, fromZero);
  for (int step = 1; step < degree; ++step) {
    const double next = 1 / (2 * sigma - rho);
    const auto keep = static_cast<float>(next * rho), gain = static_cast<float>(2 * next / delta);
    rho = next;
    apply(d.data(), y.data(), true);
    smoothStep(keep, gain, false, false);
  }
  if (!keepResidual) return;
  apply(d.data(), y.data(), true);
  forRange(size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] -= y[i];
  });
}

}  // namespace glisson::mechanics
