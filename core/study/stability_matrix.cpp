// SPDX-License-Identifier: GPL-3.0-or-later

// What must hold always: symmetry, zero modes, balance, the same bits with any threads, any scale, any size.
#include <Eigen/Eigenvalues>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "mechanics/dynamics.h"
#include "mechanics/meshfree.h"
#include "mechanics/newton_solve.h"
#include "mechanics/static_solve.h"
#include "mechanics/tet_solve.h"
#include "study/beam.h"
#include "study/detail/stability_cases.h"
#include "study/detail/timing.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;
using mechanics::HexElement;

/// The whole stiffness matrix, column by column.
Eigen::MatrixXd dense(const mechanics::VoxelOperator& op) {
  const Eigen::Index n = op.dofs();
  Eigen::MatrixXd K(n, n);
  mechanics::NodalField e = mechanics::NodalField::Zero(3, n / 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    e(i % 3, i / 3) = 1;
    K.col(i) = op.apply(e).reshaped();
    e(i % 3, i / 3) = 0;
  }
  return K;
}

Outcome modes(HexElement element, const Progress&) {
  mechanics::VoxelBody body = solidBox({3, 2, 2}, {0.03, 0.02, 0.02}, 6e3, 0.45);
  paint(body, [](const Vector3d& c) { return 6e3 * (1 + 20 * c.x() + 30 * c.y()); });
  const mechanics::VoxelMesh mesh(body);
  const Eigen::MatrixXd free = dense(mechanics::VoxelOperator(body, element));
  const double asymmetry = (free - free.transpose()).cwiseAbs().maxCoeff() / free.cwiseAbs().maxCoeff();
  const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(free, Eigen::EigenvaluesOnly).eigenvalues();
  const double top = e[e.size() - 1];
  int zero = 0;
  for (const double v : e) zero += std::abs(v) <= 1e-12 * top ? 1 : 0;
  mechanics::Supports held;
  held.fixations = clampSide(mesh, 0);
  Eigen::MatrixXd fixed = dense(mechanics::VoxelOperator(body, element, held));
  for (const mechanics::Fixation& f : held.fixations)
    for (int a = 0; a < 3; ++a) fixed(3 * f.node + a, 3 * f.node + a) = top;
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(fixed, Eigen::EigenvaluesOnly).eigenvalues()[0] / top;
  Outcome o;
  o.good = asymmetry <= 1e-14 && zero == 6 && e[0] >= -1e-12 * top && least > 1e-8;
  o.detail = words("asymmetry ", asymmetry, ", ", zero, " zero modes when free (seventh ", e[6] / top,
                   " of the largest), least eigenvalue when held ", least);
  return o;
}

mechanics::Problem loaded(int n) {
  mechanics::Problem p;
  p.body = solidBox({n, n, n}, {0.08, 0.06, 0.05}, 6e3, 0.45);
  paint(p.body, [](const Vector3d& c) { return 6e3 * (1.5 + std::sin(120 * c.x() + 60 * c.z())); });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 4);
  p.supports.springs = mechanics::faceSprings(mesh, facesOn(mesh, 0), 2e5);
  p.f_N = mechanics::bodyForce(mesh, {0, 300, -1000}) +
          mechanics::tractionForce(mesh, facesOn(mesh, 5), Vector3d(40, 0, 0));
  return p;
}

Outcome balance(const Progress& progress) {
  const mechanics::Problem p = loaded(12);
  mechanics::SolverOptions s;
  s.tolerance = 1e-12;
  const mechanics::VoxelMesh mesh(p.body);
  const mechanics::Solution r = mechanics::solveStatic(p, s, progress);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0.0;
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const Vector3d f = p.f_N.col(n) + r.reaction_N.col(n);
    force += f;
    moment += mesh.position_m(n).cross(f);
    size += p.f_N.col(n).norm();
  }
  Outcome o;
  o.add(r.report);
  o.good = force.norm() <= 1e-10 * size && moment.norm() <= 1e-10 * size * 0.08;
  o.detail =
      words("loads and reactions: force left ", force.norm() / size, ", moment left ", moment.norm() / (size * 0.08));
  return o;
}

Outcome threads(const Progress& progress) {
  struct Restore {
    int before = threadCount();
    ~Restore() { setThreadCount(before); }
  } restore;
  const mechanics::Problem p = loaded(24), small = loaded(8);
  const mechanics::Problem beam = beamProblem({}, {30, 6, 6}, Root::Clamped);
  const auto onFrames = [&](mechanics::Kernel kernel, int order, int frames) {
    mechanics::MeshfreeOptions mo;
    mo.kernel = kernel;
    mo.order = order;
    mo.frames = frames;
    return mechanics::MeshfreeModel(beam, mo).solveStatic({}, progress);
  };
  const auto onCells = [&](const mechanics::Problem& problem, mechanics::SolverKind kind, HexElement element) {
    mechanics::SolverOptions s;
    s.kind = kind;
    s.element = element;
    return mechanics::solveStatic(problem, s, progress);
  };
  using mechanics::Kernel;
  using mechanics::SolverKind;
  const std::pair<const char*, std::function<mechanics::Solution()>> ways[] = {
      {"voxels, default solver", [&] { return onCells(p, SolverKind::Auto, HexElement::Incompatible); }},
      {"voxels, multigrid", [&] { return onCells(p, SolverKind::Multigrid, HexElement::BBar); }},
      {"voxels, conjugate gradients", [&] { return onCells(small, SolverKind::Cg, HexElement::H8); }},
      {"voxels, factorised", [&] { return onCells(small, SolverKind::Factorised, HexElement::H8); }},
      {"Wendland frames", [&] { return onFrames(Kernel::Wendland, 2, 12); }},
      {"Voronoi frames", [&] { return onFrames(Kernel::Voronoi, 1, 30); }},
      {"moving least squares", [&] { return onFrames(Kernel::Mls, 2, 100); }},
      {"tetrahedra",
       [&] {
         return mechanics::solveTets(small, mechanics::onTetrahedra(small, mechanics::TetOrder::Linear), {}, progress);
       }},
      {"corotational", [&] {
         return mechanics::solveLargeDeformation(small, mechanics::LargeDeformationKind::Corotational, {}, progress);
       }}};
  Outcome o;
  std::string differ, names;
  for (const auto& [name, solve] : ways) {
    mechanics::NodalField first;
    for (const int t : {1, 2, 4}) {
      setThreadCount(t);
      const mechanics::Solution s = solve();
      if (t == 1) {
        o.add(s.report);
        first = s.u_m;
      } else if (std::memcmp(first.data(), s.u_m.data(), sizeof(double) * static_cast<std::size_t>(first.size())) !=
                 0) {
        differ += (differ.empty() ? "" : ", ") + std::string(name) + " with " + std::to_string(t);
      }
    }
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  o.good = differ.empty();
  o.detail = differ.empty() ? names + ": the same bits with 1, 2 and 4 threads" : "bits differ: " + differ;
  return o;
}

Outcome loadScales(const Progress& progress) {
  mechanics::Problem p = loaded(8);
  mechanics::StaticSolver solver(p.body, p.supports, {}, progress);
  const mechanics::NodalField f = p.f_N;
  const mechanics::NodalField unit = solver.solve(f, progress).u_m;
  Outcome o;
  double worst = 0.0;
  for (const double c : {1e-15, 1e15}) {
    const mechanics::Solution r = solver.solve(c * f, progress);
    o.add(r.report);
    worst = std::max(worst, relativeDifference(r.u_m / c, unit));
  }
  const mechanics::Solution none = solver.solve(mechanics::NodalField::Zero(3, f.cols()), progress);
  o.good = worst <= 1e-10 && none.u_m.cwiseAbs().maxCoeff() == 0.0 && none.report.converged();
  o.detail = words("load 0 gives exactly 0; 1e-15 and 1e15 times the load scale within ", worst);
  return o;
}

Outcome units(const Progress& progress) {
  // The same scene in mm, kPa and mN: every number differs, the answer must not.
  const mechanics::Problem si = loaded(10);
  mechanics::Problem mm = si;
  mm.body.h_m *= 1e3;
  for (double& E : mm.body.E_Pa) E *= 1e-3;
  mm.f_N *= 1e3;
  for (mechanics::Spring& k : mm.supports.springs) k.k_N_m *= 1.0;  // N/m and mN/mm are the same number
  mechanics::SolverOptions s;
  s.tolerance = 1e-13;
  const mechanics::Solution a = mechanics::solveStatic(si, s, progress), b = mechanics::solveStatic(mm, s, progress);
  const double off = relativeDifference(1e-3 * b.u_m, a.u_m);
  // In motion, in mm, g and s: a pascal is 1 g/(mm s2), a newton 1e6 g mm/s2.
  mechanics::Problem kg = loaded(5), g = kg;
  g.body.h_m *= 1e3;
  g.body.density_kg_m3 *= 1e-6;
  g.f_N *= 1e6;
  for (mechanics::Spring& k : g.supports.springs) k.k_N_m *= 1e3;
  mechanics::DynamicOptions d;
  d.end_s = 0.02;
  const mechanics::DynamicSolution x = mechanics::solveDynamic(kg, d, s, progress),
                                   y = mechanics::solveDynamic(g, d, s, progress);
  const double moving = relativeDifference(1e-3 * y.solution.u_m, x.solution.u_m);
  Outcome o;
  o.add(a.report);
  o.add(b.report);
  o.add(x.solution.report);
  o.add(y.solution.report);
  o.good = off <= 1e-10 && moving <= 1e-10;
  o.detail = words("m, Pa, N against mm, kPa, mN: ", off, " apart; in motion kg, m against g, mm: ", moving);
  return o;
}

Outcome size(int n, const Progress& progress) {
  mechanics::Problem p = loaded(n);
  const Stopwatch watch;
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  const double s = watch.seconds();
  Outcome o;
  o.add(r.report);
  o.good = r.report.converged() && r.u_m.allFinite();
  o.detail = words(3 * r.u_m.cols(), " degrees of freedom in ", s, " s by ", r.report.kind);
  return o;
}

}  // namespace

Scenes matrixScenes(const StabilityOptions& options) {
  Scenes s;
  const std::pair<HexElement, const char*> elements[] = {
      {HexElement::Incompatible, "H8-incompatible"}, {HexElement::BBar, "H8-Bbar"}, {HexElement::H8, "H8"}};
  for (const auto& [element, name] : elements)
    s.push_back({std::string("stiffness matrix, ") + name,
                 "symmetric to 1e-14, six zero modes when free, positive definite when held",
                 [e = element](const Progress& p) { return modes(e, p); }});
  s.push_back({"reactions and loads", "balance to 1e-10, force and moment", balance});
  s.push_back({"1, 2 and 4 threads", "the same bits", threads});
  s.push_back({"load 0, 1e-15, 1e15", "exactly 0; scales to 1e-10", loadScales});
  s.push_back({"metres or millimetres, kilograms or grams", "the same answer to 1e-10", units});
  // 3 (n + 1)^3 degrees of freedom.
  std::vector<int> sizes = {6, 14, 31};
  if (!options.quick) sizes.push_back(68);
  for (const int n : sizes)
    s.push_back({words(3 * (n + 1) * (n + 1) * (n + 1), " degrees of freedom"),
                 "solved to the tolerance; time goes on the curve", [n](const Progress& p) { return size(n, p); }});
  s.push_back({"factorisation beyond the budget", "refused with the memory it would take", [](const Progress& p) {
                 mechanics::SolverOptions o;
                 o.kind = mechanics::SolverKind::Factorised;
                 const mechanics::Problem big = loaded(30);
                 return refused([&] { mechanics::solveStatic(big, o, p); }, {"GB"});
               }});
  return s;
}

}  // namespace glisson::study
