// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>

#include "base/parallel.h"
#include "mechanics/dynamics.h"
#include "mechanics/step_solver.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t nodeChunk = 8192;

}  // namespace

struct VoxelSystem::State {
  std::shared_ptr<const VoxelOperator> voxels;
  LatticeOperator<double> M;
  StepSolver solver;
  std::vector<double> in, out;  ///< row storage, 0 where no node

  State(const std::shared_ptr<const VoxelOperator>& v, const SolverOptions& options)
      : voxels(v), M(v->implicitLattice(1, 0)), solver(v, options), in(M.size(), 0.0), out(M.size(), 0.0) {}

  /// Between nodal fields column by column and row storage.
  void toSlots(const Eigen::VectorXd& x, std::vector<double>& slots) const {
    const std::size_t n = M.lattice->nodeSlots();
    parallelChunks(static_cast<std::size_t>(x.size() / 3), nodeChunk,
                   [&, from = x.data(), to = slots.data()](std::size_t begin, std::size_t end) {
                     for (std::size_t node = begin; node < end; ++node) {
                       const std::size_t slot = voxels->slotOfNode(static_cast<int>(node));
                       for (std::size_t c = 0; c < 3; ++c) to[c * n + slot] = from[3 * node + c];
                     }
                   });
  }
  void fromSlots(const std::vector<double>& slots, Eigen::VectorXd& x) const {
    const std::size_t n = M.lattice->nodeSlots();
    x.resize(voxels->dofs());
    parallelChunks(static_cast<std::size_t>(x.size() / 3), nodeChunk,
                   [&, from = slots.data(), to = x.data()](std::size_t begin, std::size_t end) {
                     for (std::size_t node = begin; node < end; ++node) {
                       const std::size_t slot = voxels->slotOfNode(static_cast<int>(node));
                       for (std::size_t c = 0; c < 3; ++c) to[3 * node + c] = from[c * n + slot];
                     }
                   });
  }
};

VoxelSystem::VoxelSystem(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options)
    : state_(std::make_unique<State>(voxels, options)) {}
VoxelSystem::~VoxelSystem() = default;

Eigen::Index VoxelSystem::size() const {
  return state_->voxels->dofs();
}

void VoxelSystem::applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  State& s = *state_;
  const LatticeOperator<double>& K = s.voxels->lattice();
  s.toSlots(x, s.in);
  K.project(s.in.data());
  K.apply(s.in.data(), s.out.data());
  s.fromSlots(s.out, y);
}

void VoxelSystem::applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  State& s = *state_;
  s.toSlots(x, s.in);
  s.M.applyCells(s.in.data(), s.out.data());
  s.M.project(s.out.data());
  s.fromSlots(s.out, y);
}

Eigen::MatrixXd VoxelSystem::freeModes() const {
  const VoxelOperator& op = *state_->voxels;
  if (op.fixedCount() > 0 || !op.springs().empty()) return {};
  const VoxelMesh& mesh = op.mesh();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int node = 0; node < mesh.nodeCount(); ++node) centre += mesh.position_m(node) / mesh.nodeCount();
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(size(), 6);
  for (int node = 0; node < mesh.nodeCount(); ++node)
    for (int c = 0; c < 3; ++c) {
      modes(3 * node + c, c) = 1;
      modes.block<3, 1>(3 * node, 3 + c) = Eigen::Vector3d::Unit(c).cross(mesh.position_m(node) - centre);
    }
  return massOrthonormal(*this, modes);
}

void VoxelSystem::prepare(double m, double k) {
  state_->solver.prepare(m, k);
}

SolveReport VoxelSystem::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  State& s = *state_;
  s.toSlots(b, s.in);
  if (x.size() == b.size())
    s.toSlots(x, s.out);
  else
    std::fill(s.out.begin(), s.out.end(), 0.0);
  SolveReport report = s.solver.solve(s.in, s.out);
  s.fromSlots(s.out, x);
  return report;
}

}  // namespace glisson::mechanics
