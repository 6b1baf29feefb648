// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/beam_methods.h"

#include <sstream>

#include "study/detail/methods.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using mechanics::Kernel;

std::string cellsText(const Eigen::Vector3i& n) {
  return std::to_string(n.x()) + "x" + std::to_string(n.y()) + "x" + std::to_string(n.z());
}

BeamAnswer asAnswer(const Measured& m, const mechanics::VoxelMesh& mesh, const std::string& resolution) {
  BeamAnswer a;
  a.resolution = resolution;
  a.dofs = m.dofs;
  a.build_s = m.build_s;
  a.solve_s = m.solve_s;
  a.step_ms = m.step_ms;
  a.axis_mm = axisDeflection_mm(mesh, m.u_m);
  a.converged = m.converged;
  a.note = m.note;
  return a;
}

std::string withSize(const mechanics::Problem& p) {
  std::ostringstream size;
  size.precision(3);
  size << cellsText(p.body.cells) << " (" << 1e3 * p.body.h_m.z() << " mm)";
  return size.str();
}

BeamAnswer voxels(const BeamOptions& options, HexElement element, const Eigen::Vector3i& cells, Root root,
                  const Progress& progress) {
  const mechanics::Problem p = beamProblem(options, cells, root);
  mechanics::SolverOptions solver;
  solver.element = element;
  return asAnswer(quickest([&] { return measureVoxels(p, solver, 5, progress); }), mechanics::VoxelMesh(p.body),
                  withSize(p));
}

BeamAnswer tets(const BeamOptions& options, mechanics::TetOrder order, mechanics::TetPattern pattern,
                const Eigen::Vector3i& cells, Root root, const Progress& progress) {
  const mechanics::Problem p = beamProblem(options, cells, root);
  const mechanics::TetProblem problem = beamOnTetrahedra(options, p, order, pattern, root);
  return asAnswer(quickest([&] { return measureTets(p, problem, progress); }), mechanics::VoxelMesh(p.body),
                  withSize(p));
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
  mechanics::SolverOptions solver;
  if (f.published) {
    solver.kind = mechanics::SolverKind::Cg;
    solver.preconditioner = mechanics::Preconditioner::None;
    solver.iterations = 200;
  }
  const Measured m = measureFrames(p, o, solver, f.published ? 3 : 10, progress);
  return asAnswer(m, mechanics::VoxelMesh(p.body), std::to_string(m.frames) + " frames on " + cellsText(cells));
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
    methods.push_back({name, (f.kernel == Kernel::Mls ? 0.005 : 0.02) * f.count * f.order * f.order,
                       [=](Root root, const Progress& progress) {
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

  const auto addTets = [&](const std::string& name, mechanics::TetOrder order, mechanics::TetPattern pattern,
                           const Eigen::Vector3i& cells) {
    const double weight = (order == mechanics::TetOrder::Quadratic ? 1e-3 : 2e-4) * cells.prod();
    methods.push_back({name, weight, [=](Root root, const Progress& progress) {
                         BeamAnswer a = tets(options, order, pattern, cells, root, progress);
                         a.method = name;
                         return a;
                       }});
  };
  for (const Eigen::Vector3i& cells : grids)
    addTets("T4", mechanics::TetOrder::Linear, mechanics::TetPattern::Parallel, cells);
  for (const Eigen::Vector3i& cells : grids)
    addTets("T4 mirrored", mechanics::TetOrder::Linear, mechanics::TetPattern::Mirrored, cells);
  grids.pop_back();  // with its middle nodes, T10 is as fine one grid earlier
  for (const Eigen::Vector3i& cells : grids)
    addTets("T10", mechanics::TetOrder::Quadratic, mechanics::TetPattern::Mirrored, cells);

  const int base = options.quick ? 8 : 12;
  std::vector<int> affine = {30, 60}, quadratic = {12, 24}, mls = {120, 240};              // 360 and 720 dofs
  if (!options.quick) affine.push_back(150), quadratic.push_back(60), mls.push_back(600);  // 1800
  for (const int n : affine) addFrames("Voronoi, CG 200 (published)", {Kernel::Voronoi, 1, n, true}, base);
  for (const int n : affine) addFrames("Voronoi, factorised", {Kernel::Voronoi, 1, n, false}, base);
  for (const int n : affine) addFrames("Wendland affine", {Kernel::Wendland, 1, n, false}, base);
  for (const int n : quadratic) addFrames("Wendland quadratic", {Kernel::Wendland, 2, n, false}, base);
  for (const int n : mls) addFrames("MLS linear", {Kernel::Mls, 1, n, false}, base);
  for (const int n : mls) addFrames("MLS quadratic", {Kernel::Mls, 2, n, false}, base);
  return methods;
}

}  // namespace glisson::study
