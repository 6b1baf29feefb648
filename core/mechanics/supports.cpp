// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/supports.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "base/error.h"

namespace glisson::mechanics {
namespace {

/// Filled cell per box cell, −1 where empty.
struct CellIndex {
  explicit CellIndex(const VoxelMesh& mesh) : n(mesh.cells()) {
    filled.assign(static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(n.z()),
                  -1);
    for (int e = 0; e < mesh.cellCount(); ++e) filled[at(mesh.cellOf(e))] = e;
  }
  std::size_t at(const Eigen::Vector3i& p) const {
    return (static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(n.y()) + static_cast<std::size_t>(p.y())) *
               static_cast<std::size_t>(n.x()) +
           static_cast<std::size_t>(p.x());
  }
  int operator()(const Eigen::Vector3i& p) const {
    if ((p.array() < 0).any() || (p.array() >= n.array()).any()) return -1;
    return filled[at(p)];
  }
  Eigen::Vector3i n;
  std::vector<int> filled;
};

/// All 6 × 6 matrices at once: one pass over the supports.
std::vector<SupportMatrix> supportMatrices(const VoxelMesh& mesh, const Supports& supports,
                                           const Components& components) {
  const auto count = static_cast<std::size_t>(components.count());
  std::vector<Eigen::Vector3d> low(count, Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()));
  std::vector<Eigen::Vector3d> high(count, Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()));
  const CellIndex cellAt(mesh);
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const auto c = static_cast<std::size_t>(components.ofCell[static_cast<std::size_t>(e)]);
    const Eigen::Vector3d corner = mesh.cellOf(e).cast<double>().cwiseProduct(mesh.h_m());
    low[c] = low[c].cwiseMin(corner);
    high[c] = high[c].cwiseMax(corner + mesh.h_m());
  }
  std::vector<double> stiffest(count, 0.0);
  const auto componentsAt = [&](int node) {
    std::vector<std::size_t> found;
    if (node < 0 || node >= mesh.nodeCount()) return found;
    for (int a = 0; a < 8; ++a) {
      const int e = cellAt(mesh.latticeOf(node) - Eigen::Vector3i(a & 1, a >> 1 & 1, a >> 2 & 1));
      if (e < 0) continue;
      const auto c = static_cast<std::size_t>(components.ofCell[static_cast<std::size_t>(e)]);
      if (std::find(found.begin(), found.end(), c) == found.end()) found.push_back(c);
    }
    return found;
  };
  for (const Spring& s : supports.springs)
    for (const std::size_t c : componentsAt(s.node)) stiffest[c] = std::max(stiffest[c], s.k_N_m.trace());
  std::vector<SupportMatrix> S(count, SupportMatrix::Zero());
  const auto add = [&](int node, std::size_t c, const Eigen::Matrix3d& s) {
    const Eigen::Vector3d x = (mesh.position_m(node) - 0.5 * (low[c] + high[c])) / (0.5 * (high[c] - low[c]).norm());
    addSupport(S[c], x, s);
  };
  for (const Fixation& f : supports.fixations)
    for (const std::size_t c : componentsAt(f.node))
      add(f.node, c, Eigen::Vector3d(f.axis[0], f.axis[1], f.axis[2]).asDiagonal());
  for (const Spring& s : supports.springs)
    for (const std::size_t c : componentsAt(s.node))
      if (stiffest[c] > 0) add(s.node, c, s.k_N_m / stiffest[c]);
  return S;
}

void requireNode(int node, int nodes, const char* what) {
  if (node >= 0 && node < nodes) return;
  throw BadInput(std::string(what) + " at node " + std::to_string(node) + ", but the mesh has nodes 0 to " +
                 std::to_string(nodes - 1));
}

}  // namespace

DirichletData readDirichlet(const std::vector<Fixation>& fixations, int nodes) {
  DirichletData data{Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, nodes, false), NodalField::Zero(3, nodes)};
  for (const Fixation& f : fixations) {
    requireNode(f.node, nodes, "a fixation");
    for (int c = 0; c < 3; ++c) {
      if (!f.axis[static_cast<std::size_t>(c)]) continue;
      const double value = f.value_m[c];
      if (!std::isfinite(value))
        throw BadInput("the prescribed displacement of node " + std::to_string(f.node) + " is not finite");
      if (data.constrained(c, f.node) && data.value_m(c, f.node) != value)
        throw BadInput("two fixations of node " + std::to_string(f.node) + " disagree: " +
                       std::to_string(data.value_m(c, f.node)) + " m and " + std::to_string(value) + " m");
      data.constrained(c, f.node) = true;
      data.value_m(c, f.node) = value;
    }
  }
  return data;
}

void requireGoodSprings(const std::vector<Spring>& springs, int nodes) {
  for (const Spring& spring : springs) {
    requireNode(spring.node, nodes, "a spring");
    const Eigen::Matrix3d& k = spring.k_N_m;
    const double size = k.cwiseAbs().maxCoeff();
    bool good = k.allFinite() && (k - k.transpose()).cwiseAbs().maxCoeff() <= 1e-10 * size;
    if (good) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(k, Eigen::EigenvaluesOnly);
      good = eigen.eigenvalues()[0] >= -1e-10 * size;
    }
    if (good) continue;
    std::ostringstream what;
    what << "the spring at node " << spring.node << " is not symmetric positive semi-definite and finite (N/m):\n" << k;
    throw BadInput(what.str());
  }
}

NodalField reactionForces(const Eigen::Array<bool, 3, Eigen::Dynamic>& constrained, const NodalField& spring_N,
                          const NodalField& imbalance_N) {
  return constrained.select(imbalance_N.array(), spring_N.array()).matrix();
}

void addSupport(SupportMatrix& S, const Eigen::Vector3d& x, const Eigen::Matrix3d& s) {
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(),
      (Eigen::Matrix3d() << 0, x.z(), -x.y(), -x.z(), 0, x.x(), x.y(), -x.x(), 0).finished();
  S += J.transpose() * s * J;
}

int freeModesOf(const SupportMatrix& S) {
  const Eigen::SelfAdjointEigenSolver<SupportMatrix> eigen(S, Eigen::EigenvaluesOnly);
  const double largest = eigen.eigenvalues()[5];
  if (!(largest > 0)) return 6;
  return static_cast<int>((eigen.eigenvalues().array() < 1e-8 * largest).count());
}

Components findComponents(const VoxelMesh& mesh) {
  const CellIndex cellAt(mesh);
  std::vector<int> found(static_cast<std::size_t>(mesh.cellCount()), -1);
  std::vector<std::size_t> sizes;
  std::vector<int> stack;
  for (int seed = 0; seed < mesh.cellCount(); ++seed) {
    if (found[static_cast<std::size_t>(seed)] >= 0) continue;
    const int component = static_cast<int>(sizes.size());
    sizes.push_back(0);
    stack.assign(1, seed);
    found[static_cast<std::size_t>(seed)] = component;
    while (!stack.empty()) {
      const int e = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (int side = 0; side < 6; ++side) {
        Eigen::Vector3i p = mesh.cellOf(e);
        p[side / 2] += side % 2 == 0 ? -1 : 1;
        const int next = cellAt(p);
        if (next < 0 || found[static_cast<std::size_t>(next)] >= 0) continue;
        found[static_cast<std::size_t>(next)] = component;
        stack.push_back(next);
      }
    }
  }
  std::vector<int> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return sizes[static_cast<std::size_t>(a)] > sizes[static_cast<std::size_t>(b)];
  });
  std::vector<int> rank(sizes.size());
  Components components;
  for (std::size_t r = 0; r < order.size(); ++r) {
    rank[static_cast<std::size_t>(order[r])] = static_cast<int>(r);
    components.cells.push_back(sizes[static_cast<std::size_t>(order[r])]);
  }
  for (int& c : found) c = rank[static_cast<std::size_t>(c)];
  components.ofCell = std::move(found);
  return components;
}

SupportMatrix supportMatrix(const VoxelMesh& mesh, const Supports& supports, const Components& components,
                            int component) {
  if (component < 0 || component >= components.count())
    throw BadArgument("supportMatrix: there is no component " + std::to_string(component));
  return supportMatrices(mesh, supports, components)[static_cast<std::size_t>(component)];
}

std::vector<FreeComponent> findUnsupported(const VoxelMesh& mesh, const Supports& supports) {
  const Components components = findComponents(mesh);
  const std::vector<SupportMatrix> S = supportMatrices(mesh, supports, components);
  std::vector<FreeComponent> free;
  std::vector<int> place(S.size(), -1);
  for (std::size_t c = 0; c < S.size(); ++c) {
    const int modes = freeModesOf(S[c]);
    if (modes == 0) continue;
    place[c] = static_cast<int>(free.size());
    FreeComponent& f = free.emplace_back();
    f.component = static_cast<int>(c);
    f.cells = components.cells[c];
    f.volume_m3 = static_cast<double>(f.cells) * mesh.h_m().prod();
    f.freeModes = modes;
    f.firstCell.setConstant(-1);
  }
  if (free.empty()) return free;
  const CellIndex cellAt(mesh);
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const int c = components.ofCell[static_cast<std::size_t>(e)];
    if (place[static_cast<std::size_t>(c)] < 0) continue;
    FreeComponent& f = free[static_cast<std::size_t>(place[static_cast<std::size_t>(c)])];
    const Eigen::Vector3i p = mesh.cellOf(e);
    if (f.firstCell.x() < 0) f.firstCell = p;
    f.centre_m += (p.cast<double>().array() + 0.5).matrix().cwiseProduct(mesh.h_m()) / static_cast<double>(f.cells);
    for (int d = 0; d < 27 && !f.hinged; ++d) {
      const int other = cellAt(p + Eigen::Vector3i(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1));
      f.hinged = other >= 0 && components.ofCell[static_cast<std::size_t>(other)] != c;
    }
  }
  return free;
}

void requireSupported(const VoxelMesh& mesh, const Supports& supports) {
  const std::vector<FreeComponent> free = findUnsupported(mesh, supports);
  if (free.empty()) return;
  std::ostringstream what;
  what << "a static solve needs every piece of the body to be held. ";
  constexpr std::size_t named = 3;
  for (std::size_t f = 0; f < std::min(free.size(), named); ++f) {
    const FreeComponent& c = free[f];
    what << "Component " << c.component << " (" << c.cells << (c.cells == 1 ? " cell, " : " cells, ")
         << 1e6 * c.volume_m3 << " mL, around (" << (1e3 * c.centre_m).transpose() << ") mm, first cell ("
         << c.firstCell.transpose() << ")) has " << c.freeModes << " free rigid "
         << (c.freeModes == 1 ? "mode" : "modes");
    if (c.hinged) what << " and touches its neighbours only along edges or corners, which is a hinge";
    what << ". ";
  }
  if (free.size() > named) what << free.size() - named << " more are not held either. ";
  what << "Fix at least three nodes that are not in a line, or add springs, or drop the piece";
  throw BadInput(what.str());
}

VoxelBody dropComponents(const VoxelBody& body, const VoxelMesh& mesh, const std::vector<FreeComponent>& free,
                         double* dropped_m3) {
  const Components components = findComponents(mesh);
  std::vector<bool> drop(static_cast<std::size_t>(components.count()), false);
  for (const FreeComponent& f : free) drop.at(static_cast<std::size_t>(f.component)) = true;
  VoxelBody kept = body;
  int dropped = 0;
  for (int e = 0; e < mesh.cellCount(); ++e) {
    if (!drop[static_cast<std::size_t>(components.ofCell[static_cast<std::size_t>(e)])]) continue;
    const Eigen::Vector3i p = mesh.cellOf(e);
    kept.E_Pa[kept.cell(p.x(), p.y(), p.z())] = 0;
    ++dropped;
  }
  if (dropped == mesh.cellCount()) throw BadInput("no piece of the body is held: nothing would remain after dropping");
  if (dropped_m3 != nullptr) *dropped_m3 = dropped * mesh.h_m().prod();
  return kept;
}

}  // namespace glisson::mechanics
