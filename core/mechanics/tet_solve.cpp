// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/tet_solve.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

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
constexpr double freeMode = 1e-8;  ///< eigenvalue of the rigid supports, relative to the largest

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

struct Held {
  Eigen::Array<bool, 3, Eigen::Dynamic> held;
  Eigen::VectorXd value;
};

Held readFixations(const TetProblem& p) {
  const int nodes = p.mesh.nodeCount();
  Held h{Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, nodes, false), Eigen::VectorXd::Zero(3 * nodes)};
  for (const Fixation& f : p.supports.fixations) {
    if (f.node < 0 || f.node >= nodes)
      throw BadInput("a fixation at node " + std::to_string(f.node) + ": no such node");
    for (int c = 0; c < 3; ++c) {
      if (!f.axis[static_cast<std::size_t>(c)]) continue;
      double& value = h.value[3 * f.node + c];
      if (!std::isfinite(f.value_m[c]) || (h.held(c, f.node) && value != f.value_m[c]))
        throw BadInput("the fixations of node " + std::to_string(f.node) + " disagree or are not finite");
      h.held(c, f.node) = true;
      value = f.value_m[c];
    }
  }
  for (const Spring& s : p.supports.springs)
    if (s.node < 0 || s.node >= nodes || !s.k_N_m.allFinite())
      throw BadInput("a spring at node " + std::to_string(s.node) +
                     ": no such node, or a stiffness that is not finite");
  return h;
}

/// Every piece (tetrahedra that share nodes) must be held against its six rigid motions.
void requireHeld(const TetProblem& p) {
  DisjointSets pieces(static_cast<std::size_t>(p.mesh.nodeCount()));
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    for (const int node : p.mesh.tets.col(t)) pieces.join(node, p.mesh.tets(0, t));
  double stiffest = 0;
  for (const Spring& s : p.supports.springs) stiffest = std::max(stiffest, s.k_N_m.cwiseAbs().maxCoeff());
  const Eigen::Vector3d low = p.mesh.nodes_m.rowwise().minCoeff();
  const Eigen::Vector3d high = p.mesh.nodes_m.rowwise().maxCoeff();
  for (int piece = 0; piece < p.mesh.nodeCount(); ++piece) {
    if (pieces.find(piece) != piece) continue;
    Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](int node, const Eigen::Matrix3d& s) {
      if (pieces.find(node) != piece) return;
      const Eigen::Vector3d x = (p.mesh.nodes_m.col(node) - 0.5 * (low + high)) / (0.5 * (high - low).norm());
      Eigen::Matrix<double, 3, 6> J;
      J << Eigen::Matrix3d::Identity(),
          (Eigen::Matrix3d() << 0, x.z(), -x.y(), -x.z(), 0, x.x(), x.y(), -x.x(), 0).finished();
      S += J.transpose() * s * J;
    };
    for (const Fixation& f : p.supports.fixations)
      add(f.node, Eigen::Vector3d(f.axis[0], f.axis[1], f.axis[2]).asDiagonal());
    for (const Spring& s : p.supports.springs)
      if (stiffest > 0) add(s.node, s.k_N_m / stiffest);
    const auto l = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(S).eigenvalues();
    const auto modes = (l.array() <= freeMode * l[5]).count();
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

SolveReport factorise(const BlockMatrix& K, const Held& h, const VectorMap& A, const Eigen::VectorXd& b,
                      Eigen::VectorXd& x, double tolerance) {
  SolveReport report;
  report.kind = "factorised";
  BlockFactor factor(K, h.held);
  x.setZero(b.size());
  if (!factor.factorise(K)) {
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
    A(better, y);
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

}  // namespace

Solution solveTets(const TetProblem& p, const SolverOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw BadArgument("the solver's tolerance must lie between 0 and 1");
  if (options.kind == SolverKind::Multigrid)
    throw BadInput("the multigrid solver works on voxels, not on tetrahedra; use auto, factorised or cg");
  check(p);
  const Held h = readFixations(p);
  requireHeld(p);
  const int free = static_cast<int>(3 * p.mesh.nodeCount() - h.held.count());
  const bool direct = options.kind != SolverKind::Cg && free <= StaticSolver::factorisedLimit;
  if (options.kind == SolverKind::Factorised && !direct)
    throw BadInput("the factorised solver was asked for with " + std::to_string(free) +
                   " degrees of freedom; it is offered up to " + std::to_string(StaticSolver::factorisedLimit) +
                   ": use auto or cg, or a coarser mesh");
  progress.report(0, "assembling");
  BlockMatrix K = assemble(p, progress);
  const auto project = [&](Eigen::VectorXd& v) { v = h.held.reshaped().select(0.0, v.array()).matrix(); };

  Eigen::VectorXd internal;  // of the tetrahedra alone, before springs join the matrix
  const Eigen::VectorXd f = p.f_N.reshaped();
  Eigen::VectorXd springs = Eigen::VectorXd::Zero(f.size());
  const auto springForce = [&](const Eigen::VectorXd& u) {
    springs.setZero();
    for (const Spring& s : p.supports.springs) springs.segment<3>(3 * s.node) -= s.k_N_m * u.segment<3>(3 * s.node);
  };
  BlockMatrix withSprings = K;
  for (const Spring& s : p.supports.springs) withSprings.addDiagonal(s.node, s.k_N_m);
  const VectorMap A = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    withSprings.apply(x, y);
    project(y);
  };

  Eigen::VectorXd b;
  withSprings.apply(h.value, b);
  b = f - b;
  project(b);
  Eigen::VectorXd u = h.value;
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
    if (direct) {
      report = factorise(withSprings, h, A, b, x, options.tolerance);
    } else {
      const BlockJacobi jacobi(withSprings, h.held);
      VectorMap M;
      if (options.kind != SolverKind::Cg || options.preconditioner != Preconditioner::None)
        M = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) { jacobi.apply(r, z); };
      const int limit = options.iterations > 0 ? options.iterations : std::clamp(free, 1000, 20000);
      x.setZero(b.size());
      report = conjugateGradients(A, M, b, x, limit, options.tolerance, progress.part(0.3, 1.0));
      report.kind = M ? "block-jacobi-cg" : "cg";
    }
    report.why = options.kind == SolverKind::Auto
                     ? "auto, tetrahedra with " + std::to_string(free) + " degrees of freedom"
                     : std::string("asked for");
    u += scale * x;
  }
  report.tolerance = options.tolerance;
  K.apply(u, internal);
  springForce(u);
  if (report.status == SolveStatus::StoppedAtLimit) {
    Eigen::VectorXd forces = u;
    for (int node = 0; node < p.mesh.nodeCount(); ++node)
      forces.segment<3>(3 * node) = withSprings.diagonalBlock(node).diagonal().cwiseProduct(u.segment<3>(3 * node));
    project(forces);
    const double floor = 4 * std::numeric_limits<double>::epsilon() * forces.norm() / (scale * b.norm());
    if (report.residual <= floor) {
      std::ostringstream note;
      note << "; the residual reached the rounding of double precision, " << floor << ", above the tolerance asked for";
      report.why += note.str();
      report.tolerance = floor;
      report.status = SolveStatus::Converged;
    }
  }
  solution.energy_J = 0.5 * u.dot(internal - springs);
  const Eigen::VectorXd reaction = h.held.reshaped().select((internal - f).array(), springs.array()).matrix();
  solution.u_m = u.reshaped(3, p.mesh.nodeCount());
  solution.reaction_N = reaction.reshaped(3, p.mesh.nodeCount());
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

  const Held h = readFixations(p);
  Eigen::Array<bool, 3, Eigen::Dynamic> middle =
      Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, p.mesh.nodeCount(), false);
  const auto hold = [&](const std::vector<int>& corners, const std::vector<int>& middles) {
    for (int c = 0; c < 3; ++c)
      if (std::all_of(corners.begin(), corners.end(), [&](int node) { return h.held(c, node); }))
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
    f.value_m = 0.5 * (h.value.segment<3>(3 * ends(0, node)) + h.value.segment<3>(3 * ends(1, node)));
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
