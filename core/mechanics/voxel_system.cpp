#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/dynamics.h"
#include "mechanics/factorisation.h"
#include "mechanics/krylov.h"
#include "mechanics/multigrid.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics {
namespace {

constexpr int ownLimit = 2000;       ///< conjugate gradients without a limit of the options
constexpr int multigridLimit = 100;  ///< iterations of a step before Auto falls back
constexpr int directSize = 6000;     ///< degrees of freedom that Auto factorises: every step uses the factor again
/// Iterations of block-Jacobi conjugate gradients from which the multigrid is taken; an estimate from the work of both.
constexpr double worthMultigrid = 45;

}  // namespace

struct VoxelSystem::State {
  std::shared_ptr<const VoxelOperator> voxels;
  SolverOptions options;
  LatticeOperator<double> A, M;
  Preconditioning precondition;
  std::unique_ptr<Multigrid> multigrid;
  std::unique_ptr<Factorisation> factor;
  std::string kind, why;
  double m = 1, k = 1;

  void jacobi();
  void blockJacobi();
  /// Iterations that block-Jacobi conjugate gradients are expected to need.
  double expectedIterations() const;
  void choose();
};

void VoxelSystem::State::jacobi() {
  kind = "jacobi-cg";
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels->lumpedMass_kg();
  NodalField inverse = k * voxels->diagonal();
  inverse.rowwise() += m * mass_kg.transpose();
  inverse = inverse.cwiseInverse().eval();
  voxels->project(inverse);
  std::vector<double> slots(A.size());
  voxels->toSlots(inverse, slots.data());
  precondition = [slots = std::move(slots)](const std::vector<double>& r, std::vector<double>& z) {
    parallelChunks(r.size(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) z[i] = slots[i] * r[i];
    });
  };
}

void VoxelSystem::State::blockJacobi() {
  kind = "block-jacobi-cg";
  // The diagonal of a box's consistent mass is 8/27 of its row sum.
  const Eigen::VectorXd mass_kg = (8.0 / 27.0) * voxels->lumpedMass_kg();
  std::vector<Eigen::Matrix3d> blocks = voxels->blockDiagonals();
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const auto node = static_cast<int>(n);
    Eigen::Matrix3d D = k * blocks[n] + m * mass_kg[node] * Eigen::Matrix3d::Identity();
    for (int c = 0; c < 3; ++c)
      if (voxels->isFixed(node, c)) {
        D.row(c).setZero();
        D.col(c).setZero();
        D(c, c) = 1.0;
      }
    blocks[n] = D.inverse();
    for (int c = 0; c < 3; ++c)
      if (voxels->isFixed(node, c)) blocks[n](c, c) = 0.0;
  }
  precondition = [this, blocks = std::move(blocks)](const std::vector<double>& r, std::vector<double>& z) {
    const std::size_t n = A.lattice->nodeSlots();
    std::fill(z.begin(), z.end(), 0.0);
    parallelChunks(blocks.size(), 8192, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        const std::size_t s = voxels->slotOfNode(static_cast<int>(node));
        const Eigen::Vector3d v = blocks[node] * Eigen::Vector3d(r[s], r[n + s], r[2 * n + s]);
        for (std::size_t c = 0; c < 3; ++c) z[c * n + s] = v[static_cast<Eigen::Index>(c)];
      }
    });
  };
}

double VoxelSystem::State::expectedIterations() const {
  // Smooth motions weigh m · (row sum of M) against a diagonal k K + m M; the largest eigenvalue is about 3.
  const double sum = voxels->diagonal().row(0).sum();
  const double mass = voxels->lumpedMass_kg().sum();
  const double kappa = 3 * (k * sum + m * mass * 8.0 / 27.0) / (m * mass);
  return 0.5 * std::sqrt(kappa) * std::log(2 / options.tolerance);
}

void VoxelSystem::State::choose() {
  const int dofs = voxels->dofs() - voxels->fixedCount();
  std::ostringstream note;
  note << "auto, " << dofs << " degrees of freedom: ";
  if (dofs <= directSize) {
    factor = std::make_unique<Factorisation>(A, voxels->K0(), hexMass(voxels->body().h_m));
    kind = "factorised";
    note << "small enough to factorise once for all steps";
  } else {
    const double iterations = expectedIterations();
    blockJacobi();
    note << "the step's mass leaves about " << std::ceil(iterations) << " iterations to block-Jacobi";
    if (iterations > worthMultigrid && k > 0) {
      note << ", more than multigrid costs";
      multigrid = std::make_unique<Multigrid>(*voxels, MultigridOptions::forPoisson(voxels->body().poisson),
                                              MultigridMatrix{k, m});
      kind = "multigrid-pcg";
    }
  }
  why = note.str();
}

VoxelSystem::VoxelSystem(std::shared_ptr<const VoxelOperator> voxels, const SolverOptions& options)
    : state_(std::make_unique<State>()) {
  state_->voxels = std::move(voxels);
  state_->options = options;
  state_->M = state_->voxels->implicitLattice(1, 0);
}
VoxelSystem::~VoxelSystem() = default;

Eigen::Index VoxelSystem::size() const {
  return state_->voxels->dofs();
}

void VoxelSystem::applyK(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const NodalField u = Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3);
  NodalField f;
  state_->voxels->apply(u, f);
  y = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
}

void VoxelSystem::applyM(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  const LatticeOperator<double>& M = state_->M;
  std::vector<double> in(M.size());
  std::vector<double> out(M.size());
  state_->voxels->toSlots(Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3), in.data());
  M.applyCells(in.data(), out.data());
  M.project(out.data());
  NodalField f;
  state_->voxels->fromSlots(out.data(), f);
  y = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
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
  State& s = *state_;
  s.m = m;
  s.k = k;
  s.A = s.voxels->implicitLattice(m, k);
  s.precondition = nullptr;
  s.multigrid.reset();
  s.factor.reset();
  s.why = "asked for";
  switch (s.options.kind) {
    case SolverKind::Auto:
      s.choose();
      return;
    case SolverKind::Factorised:
      if (const int dofs = s.voxels->dofs() - s.voxels->fixedCount(); dofs > StaticSolver::factorisedLimit)
        throw BadInput("the factorised solver was asked for with " + std::to_string(dofs) +
                       " degrees of freedom; it is offered up to " + std::to_string(StaticSolver::factorisedLimit) +
                       ": use multigrid or auto, or larger cells");
      s.factor = std::make_unique<Factorisation>(s.A, s.voxels->K0(), hexMass(s.voxels->body().h_m));
      s.kind = "factorised";
      return;
    case SolverKind::Multigrid:
      s.multigrid = std::make_unique<Multigrid>(*s.voxels, MultigridOptions::forPoisson(s.voxels->body().poisson),
                                                MultigridMatrix{k, m});
      s.kind = "multigrid-pcg";
      return;
    case SolverKind::Cg:
      break;
  }
  if (s.options.preconditioner == Preconditioner::Jacobi) {
    s.jacobi();
  } else if (s.options.preconditioner == Preconditioner::BlockJacobi) {
    s.blockJacobi();
  } else {
    s.kind = "cg";
    s.precondition = [](const std::vector<double>& r, std::vector<double>& z) { z = r; };
  }
}

SolveReport VoxelSystem::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  State& s = *state_;
  SolveReport report;
  report.kind = s.kind;
  report.why = s.why;
  report.tolerance = s.options.tolerance;
  const std::size_t n = s.A.size();
  std::vector<double> right(n), start(n), r(n), d(n);
  s.voxels->toSlots(Eigen::Map<const NodalField>(b.data(), 3, b.size() / 3), right.data());
  s.A.project(right.data());
  const double bNorm = norm(right);
  if (bNorm == 0) {
    x = Eigen::VectorXd::Zero(b.size());
    report.status = SolveStatus::Converged;
    return report;
  }
  if (x.size() == b.size()) {
    s.voxels->toSlots(Eigen::Map<const NodalField>(x.data(), 3, x.size() / 3), start.data());
    s.A.project(start.data());
  }
  // Corrections to the start, each solved for the true residual.
  const auto residual = [&] {
    s.A.apply(start.data(), r.data());
    for (std::size_t i = 0; i < n; ++i) r[i] = right[i] - r[i];
    return norm(r);
  };
  double rNorm = residual();
  if (rNorm > bNorm) {
    // The last solution is a worse start than none: a body coming to rest.
    std::fill(start.begin(), start.end(), 0.0);
    r = right;
    rNorm = bNorm;
  }
  const auto iterate = [&](const Preconditioning& precondition, int limit, bool flexible) {
    if (rNorm <= s.options.tolerance * bNorm) {
      report.status = SolveStatus::Converged;
      report.residual = rNorm / bNorm;
      return;
    }
    KrylovOptions o;
    o.limit = s.options.iterations > 0 ? s.options.iterations : limit;
    o.tolerance = std::min(0.5, s.options.tolerance * bNorm / rNorm);
    o.flexible = flexible;
    const KrylovResult result = conjugateGradients(s.A, r, d, precondition, o, {});
    for (std::size_t i = 0; i < n; ++i) start[i] += d[i];
    report.status = result.status;
    report.iterations += result.iterations;
    report.residual = result.residual * rNorm / bNorm;
  };
  if (!std::isfinite(rNorm)) {
    report.status = SolveStatus::NotFinite;
    report.residual = rNorm / bNorm;
  } else if (s.factor) {
    // From nothing: the factor is as good without the last step's solution.
    std::fill(start.begin(), start.end(), 0.0);
    r = right;
    rNorm = bNorm;
    do {
      s.factor->solve(r.data(), d.data());
      for (std::size_t i = 0; i < n; ++i) start[i] += d[i];
      const double before = rNorm;
      rNorm = residual();
      ++report.iterations;
      if (!(rNorm < 0.5 * before)) break;
    } while (rNorm > s.options.tolerance * bNorm);
    report.residual = rNorm / bNorm;
    report.status = !std::isfinite(rNorm)                  ? SolveStatus::NotFinite
                    : rNorm <= s.options.tolerance * bNorm ? SolveStatus::Converged
                                                           : SolveStatus::StoppedAtLimit;
  } else if (s.multigrid) {
    const bool mayFallBack = s.options.kind == SolverKind::Auto && s.options.iterations == 0;
    const Preconditioning cycle = [&s](const std::vector<double>& from, std::vector<double>& to) {
      s.multigrid->cycle(from, to);
    };
    iterate(cycle, mayFallBack ? multigridLimit : 1000, true);
    if (report.status == SolveStatus::Indefinite && s.multigrid->boundByCells()) {
      rNorm = residual();
      iterate(cycle, mayFallBack ? multigridLimit : 1000, true);
    }
    if (report.status != SolveStatus::Converged && mayFallBack) {
      s.multigrid.reset();
      s.kind = report.kind = "block-jacobi-cg";
      s.why = report.why += ", but multigrid " + describe(report.status) + "; block-Jacobi conjugate gradients";
      const SolveStatus reason = report.status;
      const int spent = report.iterations;
      rNorm = residual();
      iterate(s.precondition, ownLimit, false);
      report.diagnostics.add(DiagnosticCode::SolverFellBack, {{"reason", describe(reason)},
                                                              {"spent", std::int64_t{spent}},
                                                              {"solver", s.kind},
                                                              {"iterations", std::int64_t{report.iterations - spent}}});
    }
  } else {
    iterate(s.precondition, ownLimit, false);
  }
  NodalField u;
  s.voxels->fromSlots(start.data(), u);
  x = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
  return report;
}

}  // namespace glisson::mechanics
