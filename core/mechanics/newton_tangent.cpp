// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/detail/newton_tangent.h"

#include <algorithm>
#include <atomic>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/meshfree_solve.h"
#include "mechanics/static_solve.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t batchSize = 1024;   ///< element matrices held at a time
constexpr std::size_t elementChunk = 32;  ///< per thread
constexpr int directSize = 3000;          ///< degrees of freedom that Auto factorises
constexpr double innerTolerance = 1e-3;   ///< Newton's method corrects what the inner solve leaves
constexpr double innerEnough = 0.1;       ///< a direction is of use when it leaves less than this

}  // namespace

LargeDeformationModel::LargeDeformationModel(const Problem& problem, LargeDeformationKind kind, HexElement element)
    : op_(problem.body, kind == LargeDeformationKind::Hyperelastic ? HexElement::BBar : element, problem.supports),
      kind_(kind),
      corotational_(op_.K0(), problem.body.h_m),
      neoHookean_(problem.body.poisson, problem.body.h_m) {
  const VoxelMesh& mesh = op_.mesh();
  if (op_.dofs() > largeDeformationLimit) {
    std::ostringstream what;
    what << "large deformation was asked for with " << op_.dofs()
         << " degrees of freedom; its tangent would take about " << 7e-7 * op_.dofs() << " GB. It is offered up to "
         << largeDeformationLimit << ": use larger cells";
    throw BadInput(what.str());
  }
  elements_.resize(8, mesh.cellCount());
  E_.resize(mesh.cellCount());
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const std::array<int, 8> nodes = mesh.nodesOf(e);
    for (int a = 0; a < 8; ++a) elements_(a, e) = nodes[static_cast<std::size_t>(a)];
    const Eigen::Vector3i p = mesh.cellOf(e);
    E_[e] = problem.body.E_Pa[problem.body.cell(p.x(), p.y(), p.z())];
  }
  tangent_ = std::make_unique<BlockMatrix>(mesh.nodeCount(), elements_);
}

bool LargeDeformationModel::evaluate(const Eigen::VectorXd& u, Tangent tangent, double& energy_J,
                                     Eigen::VectorXd& force_N) {
  const auto count = static_cast<std::size_t>(elements_.cols());
  const bool wantTangent = tangent != Tangent::None;
  energy_J = 0;
  force_N.setZero(u.size());
  if (wantTangent) tangent_->setZero();
  batch_.resize(std::min(batchSize, count));
  std::atomic<bool> inverted = false;
  for (std::size_t first = 0; first < count; first += batchSize) {
    const std::size_t size = std::min(batchSize, count - first);
    parallelChunks(size, elementChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto e = static_cast<Eigen::Index>(first + i);
        HexCorners corners;
        for (int a = 0; a < 8; ++a) corners.col(a) = u.segment<3>(3 * elements_(a, e));
        const bool good = kind_ == LargeDeformationKind::Corotational
                              ? corotational_.evaluate(E_[e], corners, tangent, batch_[i])
                              : neoHookean_.evaluate(E_[e], corners, tangent, batch_[i]);
        if (!good) inverted = true;
      }
    });
    if (inverted) return false;
    for (std::size_t i = 0; i < size; ++i) {
      const auto e = static_cast<Eigen::Index>(first + i);
      energy_J += batch_[i].energy_J;
      for (int a = 0; a < 8; ++a) force_N.segment<3>(3 * elements_(a, e)) += batch_[i].force_N.segment<3>(3 * a);
      if (wantTangent) tangent_->add(elements_.col(e).data(), batch_[i].tangent_N_m);
    }
  }
  for (const Spring& s : op_.springs()) {
    const Eigen::Vector3d at = u.segment<3>(3 * s.node);
    const Eigen::Vector3d f = s.k_N_m * at;
    energy_J += 0.5 * at.dot(f);
    force_N.segment<3>(3 * s.node) += f;
    if (wantTangent) tangent_->addDiagonal(s.node, s.k_N_m);
  }
  return true;
}

TangentSolver::TangentSolver(const LargeDeformationModel& model, const SolverOptions& options)
    : model_(model), options_(options) {
  const int dofs = model.op().dofs() - model.op().fixedCount();
  if (options_.kind == SolverKind::Auto) {
    mayFactorise_ = dofs <= StaticSolver::factorisedLimit;
    options_.kind = dofs <= directSize ? SolverKind::Factorised : SolverKind::Multigrid;
  }
  if (options_.kind == SolverKind::Factorised) {
    if (dofs > StaticSolver::factorisedLimit)
      throw BadInput("the factorised solver was asked for with " + std::to_string(dofs) +
                     " degrees of freedom; it is offered up to " + std::to_string(StaticSolver::factorisedLimit) +
                     ": use multigrid or auto, or larger cells");
    kind_ = "newton-factorised";
    factor_ = std::make_unique<BlockFactor>(model.tangent(), model.held());
  } else if (options_.kind == SolverKind::Multigrid) {
    kind_ = "newton-multigrid-pcg";
    multigrid_ = std::make_unique<Multigrid>(model.op());
  } else {
    kind_ = options_.preconditioner == Preconditioner::None ? "newton-cg" : "newton-block-jacobi-cg";
  }
}
TangentSolver::~TangentSolver() = default;

bool TangentSolver::solveDirectly(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (!factor_->factorise(model_.tangent())) return false;
  factor_->solve(b, x);
  return x.allFinite();
}

bool TangentSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, const Progress& progress) {
  if (factor_) return solveDirectly(b, x);
  bool converged = false;
  const bool good = iterate(b, x, converged, progress);
  if (!good || converged || !mayFactorise_) return good;
  kind_ = "newton-factorised (the multigrid did not converge)";
  factor_ = std::make_unique<BlockFactor>(model_.tangent(), model_.held());
  return solveDirectly(b, x);
}

bool TangentSolver::iterate(const Eigen::VectorXd& b, Eigen::VectorXd& x, bool& converged, const Progress& progress) {
  const auto project = [&](Eigen::VectorXd& v) { v = model_.held().reshaped().select(0.0, v.array()).matrix(); };
  const VectorMap A = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) {
    model_.tangent().apply(p, q);
    project(q);
  };
  VectorMap M;
  std::unique_ptr<BlockJacobi> blocks;
  std::vector<double> r, z;
  if (multigrid_) {
    r.resize(model_.op().lattice().size());
    z.resize(r.size());
    M = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) {
      const NodalField in = p.reshaped(3, p.size() / 3);
      NodalField out;
      model_.op().toSlots(in, r.data());
      multigrid_->cycle(r, z);
      model_.op().fromSlots(z.data(), out);
      q = out.reshaped();
    };
  } else if (options_.preconditioner != Preconditioner::None) {
    blocks = std::make_unique<BlockJacobi>(model_.tangent(), model_.held());
    M = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) { blocks->apply(p, q); };
  }
  const int limit = options_.iterations > 0 ? options_.iterations : multigrid_ ? 300 : 5000;
  x.setZero(b.size());
  const double scale = b.cwiseAbs().maxCoeff();
  const SolveReport report = conjugateGradients(A, M, b / scale, x, limit, innerTolerance, progress);
  x *= scale;
  innerIterations_ += report.iterations;
  converged = report.converged();
  if (report.status == SolveStatus::StoppedAtLimit && mayFactorise_) return true;
  return converged || (report.status == SolveStatus::StoppedAtLimit && report.residual < innerEnough);
}

}  // namespace glisson::mechanics
