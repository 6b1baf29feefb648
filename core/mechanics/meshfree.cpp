// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/meshfree.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/detail/meshfree_assembly.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {
namespace {

FrameBasis makeBasis(const VoxelMesh& mesh, const MeshfreeOptions& options, const Progress& progress) {
  SiteOptions sites;
  sites.count = options.frames;
  sites.iterations = options.lloydIterations;
  sites.seed = options.seed;
  sites.density = options.density;
  sites.minimumNodes = leastNodesOf(options.kernel, options.order);
  Sites placed = options.sites_m.cols() > 0 ? sitesAt(mesh, options.sites_m, sites.minimumNodes)
                                            : placeSites(mesh, sites, progress.part(0.0, 0.1));
  return FrameBasis(mesh, std::move(placed), {options.kernel, options.order, options.alpha}, progress.part(0.1, 0.2));
}

void checkLoad(const NodalField& f_N, int nodeCount) {
  if (f_N.cols() != nodeCount)
    throw BadArgument("mesh-free model: a load of " + std::to_string(f_N.cols()) + " columns for " +
                      std::to_string(nodeCount) + " nodes");
  if (!f_N.allFinite()) throw BadInput("the load has a value that is not finite");
}

}  // namespace

MeshfreeModel::MeshfreeModel(const Problem& problem, const MeshfreeOptions& options, HexElement element,
                             const Progress& progress)
    : voxels_(std::make_shared<VoxelOperator>(problem.body, element, problem.supports)),
      basis_(makeBasis(voxels_->mesh(), options, progress)),
      supports_(problem.supports),
      f_N_(problem.f_N) {
  const VoxelMesh& mesh = voxels_->mesh();
  if (f_N_.size() == 0) f_N_ = NodalField::Zero(3, mesh.nodeCount());
  checkLoad(f_N_, mesh.nodeCount());
  const double volume_m3 = static_cast<double>(mesh.cellCount()) * mesh.h_m().prod();
  clamp_ = distanceClamp(mesh, problem.supports, std::cbrt(volume_m3 / basis_.frames()));
  notes_ = basis_.notes();

  const ActiveFunctions active = activeFunctions(mesh, basis_, clamp_);
  number_ = active.number;
  const int all = static_cast<int>(number_.size());
  if (active.count == 0) throw BadInput("every node of the body is fixed: nothing is left to compute");
  if (active.count < all)
    notes_.push_back(std::to_string(all - active.count) + " of " + std::to_string(all) +
                     " shape functions left out: the voxels cannot tell them from the others (thin or fixed regions)");
  for (int f = 0, next = 0; f < basis_.frames(); ++f) {
    borders_.push_back(next);
    for (int b = 0; b < basis_.functions(); ++b)
      if (number_[static_cast<std::size_t>(f * basis_.functions() + b)] >= 0) next += 3;
  }
  borders_.push_back(3 * active.count);

  ReducedMatrices reduced =
      projectMatrices(problem.body, mesh, voxels_->springs(), basis_, active, clamp_, element, progress.part(0.2, 1.0));
  K_ = std::move(reduced.K_N_m);
  M_ = std::move(reduced.M_kg);
  if (clamp_.lifted) Klift_N_ = voxels_->applyFree(clamp_.lift_m) - voxels_->springForce(clamp_.lift_m);
  progress.report(1.0, "mesh-free model");
}

Eigen::VectorXd MeshfreeModel::reduce(const NodalField& f_N) const {
  checkLoad(f_N, voxels_->mesh().nodeCount());
  const VoxelMesh& mesh = voxels_->mesh();
  const int NB = basis_.functions();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(dofs());
  parallelChunks(static_cast<std::size_t>(frames()), 4, [&](std::size_t begin, std::size_t end) {
    std::array<double, 10> P{};
    for (auto f = static_cast<int>(begin); f < static_cast<int>(end); ++f)
      for (Eigen::SparseMatrix<double>::InnerIterator it(basis_.weights(), f); it; ++it) {
        const auto node = static_cast<int>(it.row());
        basis_.polynomials(f, mesh.position_m(node), P.data());
        const Eigen::Vector3d g = it.value() * clamp_.d.col(node).cwiseProduct(f_N.col(node));
        for (int b = 0; b < NB; ++b) {
          const int s = number_[static_cast<std::size_t>(f * NB + b)];
          if (s >= 0) out.segment<3>(3 * s) += P[static_cast<std::size_t>(b)] * g;
        }
      }
  });
  return out;
}

Eigen::VectorXd MeshfreeModel::load(const NodalField& f_N) const {
  if (!clamp_.lifted) return reduce(f_N);
  checkLoad(f_N, voxels_->mesh().nodeCount());
  return reduce(f_N - Klift_N_);
}

NodalField MeshfreeModel::expandRate(const Eigen::VectorXd& v) const {
  if (v.size() != dofs())
    throw BadArgument("mesh-free model: " + std::to_string(v.size()) + " values for " + std::to_string(dofs()) +
                      " degrees of freedom");
  const VoxelMesh& mesh = voxels_->mesh();
  const int NB = basis_.functions();
  NodalField u(3, mesh.nodeCount());
  parallelChunks(static_cast<std::size_t>(mesh.nodeCount()), 512, [&](std::size_t begin, std::size_t end) {
    std::array<double, 10> P{};
    for (auto node = static_cast<int>(begin); node < static_cast<int>(end); ++node) {
      const Eigen::Vector3d p = mesh.position_m(node);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(basis_.weightsByNode(), node); it; ++it) {
        const auto f = static_cast<int>(it.col());
        basis_.polynomials(f, p, P.data());
        for (int b = 0; b < NB; ++b) {
          const int s = number_[static_cast<std::size_t>(f * NB + b)];
          if (s >= 0) sum += it.value() * P[static_cast<std::size_t>(b)] * v.segment<3>(3 * s);
        }
      }
      u.col(node) = clamp_.d.col(node).cwiseProduct(sum);
    }
  });
  return u;
}

NodalField MeshfreeModel::expand(const Eigen::VectorXd& q) const {
  NodalField u = expandRate(q);
  if (clamp_.lifted) u += clamp_.lift_m;
  return u;
}

Eigen::VectorXd MeshfreeModel::nearest(const NodalField& u_m) const {
  const Eigen::VectorXd b = reduce(voxels_->applyMass(clamp_.lifted ? NodalField(u_m - clamp_.lift_m) : u_m));
  const DenseCholesky factor(M_);
  if (factor.status() != SolveStatus::Converged)
    throw SolverFailed("the mesh-free mass matrix has no Cholesky factor; use fewer frames", 0, 1.0, 0.0);
  Eigen::VectorXd q;
  factor.solve([this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { symmetricTimes(M_, x, y); }, b, q, 1e-12);
  return q;
}

Solution MeshfreeModel::solveStatic(const SolverOptions& options, const Progress& progress) const {
  return solveStatic(f_N_, options, progress);
}

Solution MeshfreeModel::solveStatic(const NodalField& f_N, const SolverOptions& options,
                                    const Progress& progress) const {
  if (options.kind == SolverKind::Multigrid)
    throw BadInput("a mesh-free model has no multigrid solver; choose auto, factorised or cg");
  requireSupported(voxels_->mesh(), supports_);
  const Eigen::VectorXd b = load(f_N);
  const VectorMap apply = [this](const Eigen::VectorXd& x, Eigen::VectorXd& y) { symmetricTimes(K_, x, y); };
  Eigen::VectorXd q;
  SolveReport report;
  const bool factorise =
      options.kind == SolverKind::Factorised || (options.kind == SolverKind::Auto && dofs() <= DenseCholesky::largest);
  if (factorise) {
    const DenseCholesky factor(K_);
    if (factor.status() == SolveStatus::Converged) {
      report = factor.solve(apply, b, q, options.tolerance);
    } else {
      report.kind = "factorised";
      report.status = factor.status();
      report.residual = 1.0;
      q = Eigen::VectorXd::Zero(dofs());
    }
    report.why = options.kind == SolverKind::Auto ? "dense Cholesky: at most 10000 degrees of freedom" : "asked for";
  } else {
    const bool automatic = options.kind == SolverKind::Auto;
    const Preconditioner kind = automatic ? Preconditioner::BlockJacobi : options.preconditioner;
    VectorMap preconditioner;
    if (kind == Preconditioner::Jacobi) preconditioner = jacobi(K_);
    if (kind == Preconditioner::BlockJacobi) preconditioner = blockJacobi(K_, borders_);
    report = conjugateGradients(apply, preconditioner, b, q, options.iterations > 0 ? options.iterations : 10 * dofs(),
                                options.tolerance, progress);
    report.why = automatic ? "block-Jacobi CG: more than 10000 degrees of freedom" : "asked for";
  }
  acceptRounding(K_, b, q, report);
  Solution out = solution(q, f_N);
  out.report = report;
  return out;
}

Solution MeshfreeModel::solution(const Eigen::VectorXd& q, const NodalField& f_N) const {
  checkLoad(f_N, voxels_->mesh().nodeCount());
  Solution out;
  out.u_m = expand(q);
  const NodalField spring_N = voxels_->springForce(out.u_m);
  const NodalField internal_N = voxels_->applyFree(out.u_m);
  out.energy_J = 0.5 * out.u_m.cwiseProduct(internal_N - spring_N).sum();
  out.reaction_N = spring_N;
  // Where d < 1 the clamp carries the share 1 − d of the imbalance.
  const NodalField rest_N = internal_N - spring_N - f_N;
  for (int node = 0; node < voxels_->mesh().nodeCount(); ++node)
    for (int c = 0; c < 3; ++c) {
      const double share = 1.0 - clamp_.d(c, node);
      if (share > 0.0) out.reaction_N(c, clamp_.nearest(c, node)) += share * rest_N(c, node);
    }
  return out;
}

}  // namespace glisson::mechanics
