// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/voxel_operator.h"

#include <map>

#include "base/error.h"
#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t nodeChunk = 16384;

}  // namespace

VoxelOperator::VoxelOperator(const VoxelBody& body, HexElement element, const Supports& supports)
    : body_(body), mesh_(body_), element_(element), K0_(hexStiffness(element, body.poisson, body.h_m)) {
  lattice_.lattice = std::make_shared<RowLattice>(body_.cells, body_.E_Pa);
  lattice_.blocks = RowBlocks<double>(walshBlocks(K0_));
  lattice_.E = cellSlotsOf<double>(*lattice_.lattice, body_.E_Pa, 1.0);
  slotOfNode_.resize(static_cast<std::size_t>(mesh_.nodeCount()));
  for (int node = 0; node < mesh_.nodeCount(); ++node) {
    const Eigen::Vector3i p = mesh_.latticeOf(node);
    slotOfNode_[static_cast<std::size_t>(node)] = lattice_.lattice->slot(p.x(), p.y(), p.z());
  }
  readSupports(supports);
}

void VoxelOperator::readSupports(const Supports& supports) {
  const int nodes = mesh_.nodeCount();
  dirichlet_ = readDirichlet(supports.fixations, nodes);
  requireGoodSprings(supports.springs, nodes);
  std::map<int, Eigen::Matrix3d> total;
  for (const Spring& s : supports.springs)
    total.try_emplace(s.node, Eigen::Matrix3d::Zero()).first->second += 0.5 * (s.k_N_m + s.k_N_m.transpose());
  for (const auto& [node, k] : total) {
    springs_.push_back({node, k});
    lattice_.springs.push_back({slotOfNode(node), {k(0, 0), k(0, 1), k(0, 2), k(1, 1), k(1, 2), k(2, 2)}});
  }
  const std::size_t n = lattice_.lattice->nodeSlots();
  for (int c = 0; c < 3; ++c)
    for (int node = 0; node < nodes; ++node)
      if (isFixed(node, c)) lattice_.fixed.push_back(static_cast<std::size_t>(c) * n + slotOfNode(node));
  fixedCount_ = static_cast<int>(lattice_.fixed.size());
}

void VoxelOperator::toSlots(const NodalField& field, double* slots) const {
  if (field.cols() != mesh_.nodeCount())
    throw BadArgument("a nodal field of " + std::to_string(field.cols()) + " nodes on a mesh of " +
                      std::to_string(mesh_.nodeCount()));
  const std::size_t n = lattice_.lattice->nodeSlots();
  std::fill(slots, slots + 3 * n, 0.0);
  parallelChunks(slotOfNode_.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node)
      for (std::size_t c = 0; c < 3; ++c)
        slots[c * n + slotOfNode_[node]] = field(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(node));
  });
}

void VoxelOperator::fromSlots(const double* slots, NodalField& field) const {
  field.resize(3, mesh_.nodeCount());
  const std::size_t n = lattice_.lattice->nodeSlots();
  parallelChunks(slotOfNode_.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node)
      for (std::size_t c = 0; c < 3; ++c)
        field(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(node)) = slots[c * n + slotOfNode_[node]];
  });
}

void VoxelOperator::apply(const NodalField& u_m, NodalField& y_N) const {
  std::vector<double> x(lattice_.size());
  std::vector<double> y(lattice_.size());
  toSlots(u_m, x.data());
  lattice_.project(x.data());
  lattice_.apply(x.data(), y.data());
  fromSlots(y.data(), y_N);
}

void VoxelOperator::applyFree(const NodalField& u_m, NodalField& y_N) const {
  std::vector<double> x(lattice_.size());
  std::vector<double> y(lattice_.size());
  toSlots(u_m, x.data());
  lattice_.applyCells(x.data(), y.data());
  fromSlots(y.data(), y_N);
}

NodalField VoxelOperator::apply(const NodalField& u_m) const {
  NodalField y;
  apply(u_m, y);
  return y;
}

NodalField VoxelOperator::applyFree(const NodalField& u_m) const {
  NodalField y;
  applyFree(u_m, y);
  return y;
}

NodalField VoxelOperator::springForce(const NodalField& u_m) const {
  NodalField f = NodalField::Zero(3, mesh_.nodeCount());
  for (const Spring& s : springs_) f.col(s.node) = -(s.k_N_m * u_m.col(s.node));
  return f;
}

std::vector<Eigen::Matrix3d> VoxelOperator::blockDiagonals() const {
  std::vector<Eigen::Matrix3d> D(static_cast<std::size_t>(mesh_.nodeCount()), Eigen::Matrix3d::Zero());
  for (int e = 0; e < mesh_.cellCount(); ++e) {
    const Eigen::Vector3i p = mesh_.cellOf(e);
    const double E = body_.E_Pa[body_.cell(p.x(), p.y(), p.z())];
    const std::array<int, 8> nodes = mesh_.nodesOf(e);
    for (int a = 0; a < 8; ++a)
      D[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])] += E * K0_.block<3, 3>(3 * a, 3 * a);
  }
  for (const Spring& s : springs_) D[static_cast<std::size_t>(s.node)] += s.k_N_m;
  return D;
}

NodalField VoxelOperator::diagonal() const {
  const std::vector<Eigen::Matrix3d> blocks = blockDiagonals();
  NodalField d(3, mesh_.nodeCount());
  for (int node = 0; node < mesh_.nodeCount(); ++node) d.col(node) = blocks[static_cast<std::size_t>(node)].diagonal();
  return d;
}

NodalField VoxelOperator::applyMass(const NodalField& v) const {
  if (v.cols() != mesh_.nodeCount()) throw BadArgument("applyMass: the field does not belong to this mesh");
  const LatticeOperator<double> M = implicitLattice(1, 0);
  std::vector<double> x(M.size());
  std::vector<double> y(M.size());
  toSlots(v, x.data());
  M.applyCells(x.data(), y.data());
  NodalField out;
  fromSlots(y.data(), out);
  return out;
}

LatticeOperator<double> VoxelOperator::implicitLattice(double mass, double stiffness) const {
  LatticeOperator<double> A;
  A.lattice = lattice_.lattice;
  A.blocks = RowBlocks<double>(walshBlocks(K0_), walshValues(hexMass(body_.h_m)));
  A.E = lattice_.E;
  A.rho.resize(A.E.size());
  for (std::size_t i = 0; i < A.E.size(); ++i) {
    A.rho[i] = A.E[i] != 0 ? mass * body_.density_kg_m3 : 0.0;
    A.E[i] *= stiffness;
  }
  A.springs = lattice_.springs;
  for (auto& spring : A.springs)
    for (double& k : spring.k) k *= stiffness;
  A.fixed = lattice_.fixed;
  return A;
}

Eigen::VectorXd VoxelOperator::lumpedMass_kg() const {
  const double share = body_.density_kg_m3 * body_.h_m.prod() / 8;
  Eigen::VectorXd m = Eigen::VectorXd::Zero(mesh_.nodeCount());
  for (int e = 0; e < mesh_.cellCount(); ++e)
    for (const int node : mesh_.nodesOf(e)) m[node] += share;
  return m;
}

void VoxelOperator::project(NodalField& field) const {
  if (field.cols() != mesh_.nodeCount()) throw BadArgument("project: the field does not belong to this mesh");
  field = fixed().select(0.0, field.array()).matrix();
}

}  // namespace glisson::mechanics
