// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/tet_solve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/block_matrix.h"
#include "mechanics/meshfree_solve.h"
#include "mechanics/static_solve.h"
#include "mechanics/supports.h"
#include "mechanics/tet_element.h"
#include "mechanics/tet_faces.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t batchSize = 1024;

void check(const TetProblem& p) {
  const TetMesh& m = p.mesh;
  if ((m.tets.rows() != 4 && m.tets.rows() != 10) || m.tets.cols() == 0 || m.E_Pa.size() != m.tets.cols())
    throw BadArgument("a tetrahedral mesh needs 4 or 10 nodes per tetrahedron and one modulus each");
  if (p.f_N.cols() != m.nodeCount())
    throw BadArgument("the load has " + std::to_string(p.f_N.cols()) + " nodes, the mesh " +
                      std::to_string(m.nodeCount()));
  if (!p.f_N.allFinite()) throw BadInput("the load is not finite at some node");
  if (!m.nodes_m.allFinite()) throw BadInput("the place of some node is not finite");
  if (!(p.poisson > -1 && p.poisson < 0.5))
    throw BadInput("Poisson's ratio is " + std::to_string(p.poisson) + "; it must lie above -1 and below 0.5");
  std::vector<char> used(static_cast<std::size_t>(m.nodeCount()), 0);
  for (int t = 0; t < m.tetCount(); ++t) {
    if (!(m.E_Pa[t] > 0 && std::isfinite(m.E_Pa[t])))
      throw BadInput("Young's modulus of tetrahedron " + std::to_string(t) + " is " + std::to_string(m.E_Pa[t]) +
                     " Pa; it must be positive and finite");
    for (const int node : m.tets.col(t)) {
      if (node < 0 || node >= m.nodeCount())
        throw BadInput("tetrahedron " + std::to_string(t) + " names node " + std::to_string(node) +
                       ", but the mesh has nodes 0 to " + std::to_string(m.nodeCount() - 1));
      used[static_cast<std::size_t>(node)] = 1;
    }
  }
  for (std::size_t node = 0; node < used.size(); ++node)
    if (used[node] == 0) throw BadInput("node " + std::to_string(node) + " belongs to no tetrahedron; remove it");
}

/// Every piece (tetrahedra that share nodes) must be supported against its six rigid motions.
void requirePiecesSupported(const TetProblem& p) {
  DisjointSets pieces(static_cast<std::size_t>(p.mesh.nodeCount()));
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    for (const int node : p.mesh.tets.col(t)) pieces.join(node, p.mesh.tets(0, t));
  double stiffest = 0;
  for (const Spring& s : p.supports.springs) stiffest = std::max(stiffest, s.k_N_m.cwiseAbs().maxCoeff());
  const Eigen::Vector3d low = p.mesh.nodes_m.rowwise().minCoeff();
  const Eigen::Vector3d high = p.mesh.nodes_m.rowwise().maxCoeff();
  for (int piece = 0; piece < p.mesh.nodeCount(); ++piece) {
    if (pieces.find(piece) != piece) continue;
    SupportMatrix S = SupportMatrix::Zero();
    const auto add = [&](int node, const Eigen::Matrix3d& s) {
      if (pieces.find(node) != piece) return;
      const Eigen::Vector3d x = (p.mesh.nodes_m.col(node) - 0.5 * (low + high)) / (0.5 * (high - low).norm());
      addSupport(S, x, s);
    };
    for (const Fixation& f : p.supports.fixations)
      add(f.node, Eigen::Vector3d(f.axis[0], f.axis[1], f.axis[2]).asDiagonal());
    for (const Spring& s : p.supports.springs)
      if (stiffest > 0) add(s.node, s.k_N_m / stiffest);
    const int modes = freeModesOf(S);
    if (modes > 0)
      throw BadInput("the piece of the mesh with node " + std::to_string(piece) + " is free to move in " +
                     std::to_string(modes) + " rigid modes; support it");
  }
}

BlockMatrix assemble(const TetProblem& p, const Progress& progress) {
  BlockMatrix K(p.mesh.nodeCount(), p.mesh.tets);
  const auto count = static_cast<std::size_t>(p.mesh.tetCount());
  std::vector<Eigen::MatrixXd> batch(std::min(batchSize, count));
  for (std::size_t first = 0; first < count; first += batchSize) {
    progress.check();
    const std::size_t size = std::min(batchSize, count - first);
    parallelChunks(size, 32, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) batch[i] = tetStiffness(p.mesh, static_cast<int>(first + i), p.poisson);
    });
    for (std::size_t i = 0; i < size; ++i)
      K.add(p.mesh.tets.col(static_cast<Eigen::Index>(first + i)).data(), batch[i]);
  }
  return K;
}

/// Matrix and supports of a problem.
class TetSystem {
 public:
  TetSystem(const TetProblem& problem, DirichletData dirichlet, const Progress& progress)
      : problem_(problem),
        dirichlet_(std::move(dirichlet)),
        cells_(assemble(problem, progress)),
        withSprings_(cells_),
        load_(problem.f_N.reshaped()) {
    for (const Spring& s : problem.supports.springs) withSprings_.addDiagonal(s.node, s.k_N_m);
  }

  const DirichletData& dirichlet() const { return dirichlet_; }
  const BlockMatrix& matrix() const { return withSprings_; }
  int free() const { return static_cast<int>(dirichlet_.constrained.size() - dirichlet_.constrained.count()); }
  /// Sets constrained degrees of freedom to 0.
  void project(Eigen::VectorXd& v) const { v = dirichlet_.constrained.reshaped().select(0.0, v.array()).matrix(); }
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
    withSprings_.apply(x, y);
    project(y);
  }
  Eigen::VectorXd prescribed() const { return dirichlet_.value_m.reshaped(); }
  /// Load on the free degrees of freedom, that of prescribed displacements included.
  Eigen::VectorXd rightSide() const {
    Eigen::VectorXd b;
    withSprings_.apply(prescribed(), b);
    b = load_ - b;
    project(b);
    return b;
  }
  /// Displacement, reactions and energy of u.
  void recover(const Eigen::VectorXd& u, Solution& solution) const;
  /// Norm of the rounding of A u in double precision.
  double rounding(const Eigen::VectorXd& u) const;

 private:
  const TetProblem& problem_;
  DirichletData dirichlet_;
  BlockMatrix cells_;        ///< of the tetrahedra alone
  BlockMatrix withSprings_;  ///< springs added
  Eigen::VectorXd load_;
};

void TetSystem::recover(const Eigen::VectorXd& u, Solution& solution) const {
  const Eigen::Index nodes = problem_.mesh.nodeCount();
  Eigen::VectorXd internal, springs = Eigen::VectorXd::Zero(u.size());
  cells_.apply(u, internal);
  for (const Spring& s : problem_.supports.springs)
    springs.segment<3>(3 * s.node) -= s.k_N_m * u.segment<3>(3 * s.node);
  solution.u_m = u.reshaped(3, nodes);
  solution.energy_J = 0.5 * u.dot(internal - springs);
  solution.reaction_N =
      reactionForces(dirichlet_.constrained, springs.reshaped(3, nodes), (internal - load_).reshaped(3, nodes));
}

double TetSystem::rounding(const Eigen::VectorXd& u) const {
  Eigen::VectorXd forces = u;
  for (int node = 0; node < problem_.mesh.nodeCount(); ++node)
    forces.segment<3>(3 * node) = withSprings_.diagonalBlock(node).diagonal().cwiseProduct(u.segment<3>(3 * node));
  project(forces);
  return 4 * std::numeric_limits<double>::epsilon() * forces.norm();
}

/// Direct solve with refinement; the iterations are the corrections made.
SolveReport factorise(const TetSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) {
  SolveReport report;
  report.kind = "factorised";
  BlockFactor factor(system.matrix(), system.dirichlet().constrained);
  x.setZero(b.size());
  if (!factor.factorise(system.matrix())) {
    report.status = SolveStatus::Indefinite;
    report.residual = 1;
    return report;
  }
  Eigen::VectorXd r = b;
  Eigen::VectorXd d, y;
  report.residual = 1;
  for (; report.iterations < 8; ++report.iterations) {
    factor.solve(r, d);
    const Eigen::VectorXd better = x + d;
    system.apply(better, y);
    y = b - y;
    const double residual = y.norm() / b.norm();
    if (!std::isfinite(residual)) {
      report.status = SolveStatus::NotFinite;
      return report;
    }
    if (residual >= report.residual) break;
    const bool slow = residual > 0.5 * report.residual;
    report.residual = residual;
    x = better;
    r = y;
    if (slow || residual < 1e-15) break;
  }
  report.status = report.residual <= tolerance ? SolveStatus::Converged : SolveStatus::StoppedAtLimit;
  return report;
}

SolveReport iterate(const TetSystem& system, const SolverOptions& options, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                    const Progress& progress) {
  const BlockJacobi jacobi(system.matrix(), system.dirichlet().constrained);
  const VectorMap A = [&](const Eigen::VectorXd& p, Eigen::VectorXd& q) { system.apply(p, q); };
  VectorMap M;
  if (options.kind != SolverKind::Cg || options.preconditioner != Preconditioner::None)
    M = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { jacobi.apply(r, z); };
  const int limit = options.iterations > 0 ? options.iterations : std::clamp(system.free(), 1000, 20000);
  x.setZero(b.size());
  SolveReport report = conjugateGradients(A, M, b, x, limit, options.tolerance, progress);
  report.kind = M ? "block-jacobi-cg" : "cg";
  return report;
}

/// True where the problem is solved directly. Throws BadInput on a solver that tetrahedra have not.
bool isDirect(const SolverOptions& options, int free) {
  const bool direct = options.kind != SolverKind::Cg && free <= StaticSolver::factorisedLimit;
  if (options.kind == SolverKind::Factorised && !direct)
    throw BadInput("the factorised solver was asked for with " + std::to_string(free) +
                   " degrees of freedom; it is offered up to " + std::to_string(StaticSolver::factorisedLimit) +
                   ": use auto or cg, or a coarser mesh");
  return direct;
}

}  // namespace

Solution solveTets(const TetProblem& p, const SolverOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw BadArgument("the solver's tolerance must lie between 0 and 1");
  if (options.kind == SolverKind::Multigrid)
    throw BadInput("the multigrid solver works on voxels, not on tetrahedra; use auto, factorised or cg");
  check(p);
  DirichletData dirichlet = readDirichlet(p.supports.fixations, p.mesh.nodeCount());
  requireGoodSprings(p.supports.springs, p.mesh.nodeCount());
  requirePiecesSupported(p);
  const bool direct = isDirect(options, static_cast<int>(dirichlet.constrained.size() - dirichlet.constrained.count()));
  progress.report(0, "assembling");
  const TetSystem system(p, std::move(dirichlet), progress);

  Eigen::VectorXd b = system.rightSide();
  Eigen::VectorXd u = system.prescribed();
  Solution solution;
  SolveReport& report = solution.report;
  const double scale = b.cwiseAbs().maxCoeff();
  if (scale == 0) {
    report.kind = "none";
    report.why = "no load on a free degree of freedom";
    report.status = SolveStatus::Converged;
  } else {
    b /= scale;
    Eigen::VectorXd x;
    progress.report(0.3, "solving");
    report =
        direct ? factorise(system, b, x, options.tolerance) : iterate(system, options, b, x, progress.part(0.3, 1.0));
    report.why = options.kind == SolverKind::Auto
                     ? "auto, tetrahedra with " + std::to_string(system.free()) + " degrees of freedom"
                     : std::string("asked for");
    u += scale * x;
  }
  report.tolerance = options.tolerance;
  if (report.status == SolveStatus::StoppedAtLimit) acceptRounding(system.rounding(u) / (scale * b.norm()), report);
  system.recover(u, solution);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

TetProblem onTetrahedra(const Problem& problem, TetOrder order, TetPattern pattern) {
  const VoxelMesh voxels(problem.body);
  if (problem.f_N.cols() != voxels.nodeCount())
    throw BadArgument("the load has " + std::to_string(problem.f_N.cols()) + " nodes, the mesh " +
                      std::to_string(voxels.nodeCount()));
  TetProblem p;
  p.poisson = problem.body.poisson;
  p.supports = problem.supports;
  p.mesh = tetrahedra(problem.body, voxels, pattern);
  if (order == TetOrder::Quadratic) p.mesh = withMiddles(p.mesh);
  p.f_N = NodalField::Zero(3, p.mesh.nodeCount());
  p.f_N.leftCols(voxels.nodeCount()) = problem.f_N;
  if (order == TetOrder::Linear) return p;

  const DirichletData dirichlet = readDirichlet(p.supports.fixations, p.mesh.nodeCount());
  Eigen::Array<bool, 3, Eigen::Dynamic> middle =
      Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, p.mesh.nodeCount(), false);
  const auto hold = [&](const std::vector<int>& corners, const std::vector<int>& middles) {
    for (int c = 0; c < 3; ++c)
      if (std::all_of(corners.begin(), corners.end(), [&](int node) { return dirichlet.constrained(c, node); }))
        for (const int node : middles) middle(c, node) = true;
  };
  for (const TetFace& face : exteriorFaces(p.mesh)) {
    const std::vector<int> n = nodesOf(p.mesh, face);
    hold({n.begin(), n.begin() + 3}, {n.begin() + 3, n.end()});
  }
  Eigen::Matrix2Xi ends(2, p.mesh.nodeCount());
  for (int t = 0; t < p.mesh.tetCount(); ++t) {
    const auto n = p.mesh.tets.col(t);
    hold({n.begin(), n.begin() + 4}, {n.begin() + 4, n.end()});
    for (int e = 0; e < 6; ++e) {
      const auto& edge = tetEdges[static_cast<std::size_t>(e)];
      ends.col(n[4 + e]) << n[edge[0]], n[edge[1]];
    }
  }
  for (int node = voxels.nodeCount(); node < p.mesh.nodeCount(); ++node) {
    if (!middle.col(node).any()) continue;
    Fixation f{node, {middle(0, node), middle(1, node), middle(2, node)}, Eigen::Vector3d::Zero()};
    f.value_m = 0.5 * (dirichlet.value_m.col(ends(0, node)) + dirichlet.value_m.col(ends(1, node)));
    p.supports.fixations.push_back(f);
  }
  return p;
}

void layFoundations(TetProblem& tets, const VoxelMesh& voxels, const std::vector<Foundation>& foundations) {
  tets.supports.springs.clear();
  const VoxelFacesOnTets onTets(voxels, tets.mesh);
  std::map<int, Eigen::Matrix3d> atNode;
  for (const Foundation& f : foundations)
    for (const auto& [node, share] : onTets.shares(f.face)) {
      Eigen::Matrix3d& k = atNode.try_emplace(node, Eigen::Matrix3d::Zero()).first->second;
      k += share * faceArea_m2(voxels, f.face.side) * f.k_N_m3;
    }
  for (const auto& [node, k] : atNode) tets.supports.springs.push_back({node, k});
}

Solution solveTets(const Problem& problem, const TetProblem& tets, const SolverOptions& options,
                   const Progress& progress) {
  const VoxelMesh voxels(problem.body);
  requireSupported(voxels, problem.supports);
  Solution s = solveTets(tets, options, progress);
  if (tets.mesh.quadratic()) {
    std::vector<char> done(static_cast<std::size_t>(tets.mesh.nodeCount()), 0);
    for (int t = 0; t < tets.mesh.tetCount(); ++t)
      for (int e = 0; e < 6; ++e) {
        const int node = tets.mesh.tets(4 + e, t);
        if (done[static_cast<std::size_t>(node)] != 0) continue;
        done[static_cast<std::size_t>(node)] = 1;
        for (const int end : tetEdges[static_cast<std::size_t>(e)])
          s.reaction_N.col(tets.mesh.tets(end, t)) += 0.5 * s.reaction_N.col(node);
      }
  }
  s.u_m = s.u_m.leftCols(voxels.nodeCount()).eval();
  s.reaction_N = s.reaction_N.leftCols(voxels.nodeCount()).eval();
  return s;
}

}  // namespace glisson::mechanics
