#include "study/beam_methods.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include "mechanics/dynamics.h"
#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "study/timing.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using mechanics::Kernel;

std::string cellsText(const Eigen::Vector3i& n) {
  return std::to_string(n.x()) + "x" + std::to_string(n.y()) + "x" + std::to_string(n.z());
}

std::string ending(const mechanics::SolveReport& r) {
  if (r.converged()) return {};
  std::ostringstream t;
  t.precision(2);
  t << mechanics::describe(r.status) << " after " << r.iterations << " iterations, residual " << r.residual;
  return t.str();
}

BeamAnswer voxels(const BeamOptions& options, HexElement element, const Eigen::Vector3i& cells, Root root,
                  const Progress& progress) {
  const mechanics::Problem p = beamProblem(options, cells, root);
  BeamAnswer a;
  std::ostringstream size;
  size.precision(3);
  size << cellsText(cells) << " (" << 1e3 * p.body.h_m.z() << " mm)";
  a.resolution = size.str();
  mechanics::SolverOptions solver;
  solver.element = element;
  const Stopwatch build;
  mechanics::StaticSolver s(p.body, p.supports, solver, progress);
  a.build_s = build.seconds();
  // Hierarchy or factor are made in the first solve: a second one shows what the solve alone takes.
  const Stopwatch both;
  const mechanics::Solution answer = s.solve(p.f_N, progress);
  const double first_s = both.seconds();
  const Stopwatch again;
  s.solve(p.f_N, progress);
  a.solve_s = std::min(again.seconds(), first_s);
  a.build_s += first_s - a.solve_s;
  a.dofs = s.voxels().dofs();
  a.axis_mm = axisDeflection_mm(s.mesh(), answer.u_m);
  a.converged = answer.report.converged();
  a.note = ending(answer.report);
  const auto operation = std::make_shared<const mechanics::VoxelOperator>(p.body, element, p.supports);
  mechanics::NodalField load = p.f_N;
  operation->project(load);
  mechanics::VoxelSystem system(operation);
  a.step_ms = stepTime_ms(system, load.reshaped(), 5, progress);
  return a;
}

struct Frames {
  Kernel kernel = Kernel::Wendland;
  int order = 1;
  int count = 60;
  bool published = false;  ///< conjugate gradients without preconditioner, stopped at 200
};

BeamAnswer frames(const BeamOptions& options, const Frames& f, int base, Root root, const Progress& progress) {
  const Eigen::Vector3i cells(5 * base, base, base);
  const mechanics::Problem p = beamProblem(options, cells, root);
  mechanics::MeshfreeOptions o;
  o.kernel = f.kernel;
  o.order = f.order;
  o.frames = f.count;
  BeamAnswer a;
  const Stopwatch build;
  const mechanics::MeshfreeModel model(p, o, HexElement::Incompatible, progress);
  a.build_s = build.seconds();
  mechanics::SolverOptions solver;
  if (f.published) {
    solver.kind = mechanics::SolverKind::Cg;
    solver.preconditioner = mechanics::Preconditioner::None;
    solver.iterations = 200;
  }
  const Stopwatch watch;
  const mechanics::Solution answer = model.solveStatic(solver, progress);
  a.solve_s = watch.seconds();
  a.dofs = model.dofs();
  a.resolution = std::to_string(model.frames()) + " frames on " + cellsText(cells);
  a.axis_mm = axisDeflection_mm(model.voxels().mesh(), answer.u_m);
  a.converged = answer.report.converged();
  a.note = ending(answer.report);
  mechanics::MatrixSystem system(model.K(), model.M(), solver, model.borders());
  a.step_ms = stepTime_ms(system, model.load(p.f_N), f.published ? 3 : 10, progress);
  return a;
}

}  // namespace

std::vector<BeamMethod> beamMethods(const BeamOptions& options) {
  std::vector<BeamMethod> methods;
  const auto addVoxels = [&](const std::string& name, HexElement element, const Eigen::Vector3i& cells) {
    methods.push_back({name, 1e-4 * cells.prod(), [=](Root root, const Progress& progress) {
                         BeamAnswer a = voxels(options, element, cells, root, progress);
                         a.method = name;
                         return a;
                       }});
  };
  const auto addFrames = [&](const std::string& name, const Frames& f, int base) {
    methods.push_back({name, 0.02 * f.count * f.order * f.order, [=](Root root, const Progress& progress) {
                         BeamAnswer a = frames(options, f, base, root, progress);
                         a.method = name;
                         return a;
                       }});
  };
  std::vector<Eigen::Vector3i> grids = {{15, 3, 3}, {30, 6, 6}};
  if (!options.quick) grids.push_back({61, 12, 12});
  for (const Eigen::Vector3i& cells : grids) addVoxels("H8", HexElement::H8, cells);
  for (const Eigen::Vector3i& cells : grids) addVoxels("H8-Bbar", HexElement::BBar, cells);
  for (const Eigen::Vector3i& cells : grids) addVoxels("H8-incompatible", HexElement::Incompatible, cells);

  const int base = options.quick ? 8 : 12;
  std::vector<int> affine = {30, 60}, quadratic = {12, 24};            // 360 and 720 degrees of freedom
  if (!options.quick) affine.push_back(150), quadratic.push_back(60);  // 1800
  for (const int n : affine) addFrames("Voronoi, CG 200 (published)", {Kernel::Voronoi, 1, n, true}, base);
  for (const int n : affine) addFrames("Voronoi, factorised", {Kernel::Voronoi, 1, n, false}, base);
  for (const int n : affine) addFrames("Wendland affine", {Kernel::Wendland, 1, n, false}, base);
  for (const int n : quadratic) addFrames("Wendland quadratic", {Kernel::Wendland, 2, n, false}, base);
  return methods;
}

}  // namespace glisson::study
