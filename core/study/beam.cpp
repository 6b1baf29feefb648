// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/beam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "mechanics/loads.h"
#include "mechanics/measures.h"
#include "mechanics/static_solve.h"
#include "study/detail/beam_methods.h"

namespace glisson::study {
namespace {

constexpr int intervals = 30;

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::abs(a[i] - b[i]);
    if (!(d <= largest)) largest = d;  // takes a NaN too
  }
  return largest;
}

std::vector<double> stations(const mechanics::Cantilever& beam, double load_N_m, bool shear) {
  std::vector<double> w;
  for (int i = 0; i <= intervals; ++i) {
    const double x = beam.length_m * i / intervals;
    w.push_back(1e3 * (shear ? mechanics::timoshenkoDeflection_m(beam, load_N_m, x)
                             : mechanics::eulerBernoulliDeflection_m(beam, load_N_m, x)));
  }
  return w;
}

/// Shear of the whole load at the root, parabolic over the height: its mean between two heights.
double rootShear_Pa(const mechanics::Cantilever& beam, double load_N_m, double low_m, double high_m) {
  const double half = 0.5 * beam.height_m;
  const double shear_N = load_N_m * beam.length_m;
  const auto upTo = [&](double z) { return 0.75 * shear_N / half * (z - z * z * z / (3 * half * half)); };
  return (upTo(high_m - half) - upTo(low_m - half)) / ((high_m - low_m) * beam.width_m);
}

/// Row of one method against one reference curve.
Row against(const BeamAnswer& a, const std::vector<double>& reference_mm, const std::string& name) {
  Row r;
  r.method = a.method;
  r.resolution = a.resolution;
  r.dofs = a.dofs;
  r.build_s = a.build_s;
  r.solve_s = a.solve_s;
  r.step_ms = a.step_ms;
  r.reference = name;
  r.converged = a.converged;
  r.note = a.note;
  r.max_error_mm = largestDifference(a.axis_mm, reference_mm);
  r.tip_error_mm = std::abs(a.axis_mm.back() - reference_mm.back());
  for (std::size_t i = 0; i < reference_mm.size(); ++i)
    r.mean_error_mm += std::abs(a.axis_mm[i] - reference_mm[i]) / static_cast<double>(reference_mm.size());
  return r;
}

}  // namespace

mechanics::Cantilever validationBeam(double poisson) {
  mechanics::Cantilever beam;
  beam.poisson = poisson;
  return beam;
}

mechanics::Problem beamProblem(const BeamOptions& options, const Eigen::Vector3i& cells, Root root) {
  if (!(options.tip_mm > 0) || !std::isfinite(options.tip_mm))
    throw BadInput("the tip deflection of the validation beam is " + std::to_string(options.tip_mm) +
                   " mm; give a positive number");
  const mechanics::Cantilever beam = validationBeam(options.poisson);
  const Eigen::Vector3d size_m(beam.length_m, beam.width_m, beam.height_m);
  mechanics::Problem p;
  p.body.cells = cells;
  p.body.h_m = size_m.cwiseQuotient(cells.cast<double>());
  p.body.E_Pa.assign(static_cast<std::size_t>(cells.prod()), beam.E_Pa);
  p.body.poisson = options.poisson;
  const mechanics::VoxelMesh mesh(p.body);
  const double load_N_m = mechanics::loadForTip_N_m(beam, 1e-3 * options.tip_mm);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -load_N_m / beam.area_m2()});
  std::vector<mechanics::Face> face;
  for (const mechanics::Face& f : mechanics::exteriorFaces(mesh))
    if (f.side == 0) face.push_back(f);
  const std::vector<int> nodes = mechanics::nodesOfFaces(mesh, face);
  if (root == Root::Clamped) {
    p.supports.fixations = mechanics::fix(nodes);
    return p;
  }
  p.supports.fixations = mechanics::fix(nodes, {true, false, false});
  Eigen::Matrix3Xd traction = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(face.size()));
  for (std::size_t i = 0; i < face.size(); ++i) {
    const double middle = mechanics::faceCentre_m(mesh, face[i]).z();
    traction(2, static_cast<Eigen::Index>(i)) =
        rootShear_Pa(beam, load_N_m, middle - 0.5 * mesh.h_m().z(), middle + 0.5 * mesh.h_m().z());
  }
  p.f_N += mechanics::tractionForce(mesh, face, traction);
  // The loads balance, so any spring leaves the answer alone up to its share of the section's own stiffness.
  const double foundation = 1e-5 * beam.E_Pa / beam.height_m;
  p.supports.springs = mechanics::faceSprings(mesh, face, foundation);
  return p;
}

mechanics::TetProblem beamOnTetrahedra(const BeamOptions& options, const mechanics::Problem& problem,
                                       mechanics::TetOrder order, mechanics::TetPattern pattern, Root root) {
  const mechanics::Cantilever beam = validationBeam(options.poisson);
  const double load_N_m = mechanics::loadForTip_N_m(beam, 1e-3 * options.tip_mm);
  mechanics::TetProblem tets = mechanics::onTetrahedra(problem, order, pattern);
  tets.f_N = mechanics::bodyForce(tets.mesh, {0, 0, -load_N_m / beam.area_m2()});
  if (root == Root::Clamped) return tets;
  const double h = problem.body.h_m.z();
  for (const mechanics::TetFace& face : mechanics::exteriorFaces(tets.mesh)) {
    double x = 0.0, z = 0.0;
    for (int c = 0; c < 3; ++c) {
      const int corner = mechanics::nodesOf(tets.mesh, face)[static_cast<std::size_t>(c)];
      x = std::max(x, tets.mesh.nodes_m(0, corner));
      z += tets.mesh.nodes_m(2, corner) / 3.0;
    }
    if (x > 0.0) continue;
    const double low = h * std::floor(z / h);  // of the cell that the triangle belongs to
    tets.f_N += mechanics::tractionForce(tets.mesh, {face}, {0, 0, rootShear_Pa(beam, load_N_m, low, low + h)});
  }
  return tets;
}

std::vector<double> axisDeflection_mm(const mechanics::VoxelMesh& mesh, const mechanics::NodalField& u_m) {
  const Eigen::Vector3d size_m = mesh.cells().cast<double>().cwiseProduct(mesh.h_m());
  std::vector<double> w;
  double root = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const Eigen::Vector3d p(size_m.x() * i / intervals, 0.5 * size_m.y(), 0.5 * size_m.z());
    const auto u = mechanics::displacementAt(mesh, u_m, p);
    if (!u) throw BadArgument("axisDeflection_mm: the axis leaves the body");
    if (i == 0) root = u->z();
    w.push_back(-1e3 * (u->z() - root));
  }
  return w;
}

ConvergedBeam convergedBeam(const BeamOptions& options, Root root, int finest, const Progress& progress) {
  std::vector<std::vector<double>> w;
  ConvergedBeam c;
  for (int level = 2; level >= 0; --level) {
    const int n = finest >> level;
    progress.report(level == 2 ? 0.0 : level == 1 ? 0.05 : 0.2, "3-D reference");
    const mechanics::Problem p = beamProblem(options, {5 * n, n, n}, root);
    mechanics::SolverOptions solver;
    solver.tolerance = 1e-9;
    mechanics::StaticSolver s(p.body, p.supports, solver, progress.part(0.2, 1.0));
    const mechanics::Solution answer = s.solve(p.f_N, progress.part(0.2, 1.0));
    if (!answer.report.converged() && answer.report.residual > 1e-7)
      throw SolverFailed("the 3-D reference of the beam did not converge: choose a smaller Poisson's ratio",
                         answer.report.iterations, answer.report.residual, solver.tolerance);
    w.push_back(axisDeflection_mm(s.mesh(), answer.u_m));
    c.dofs = s.voxels().dofs();
    c.grid = std::to_string(5 * n) + "x" + std::to_string(n) + "x" + std::to_string(n);
  }
  const double ratio = (w[1].back() - w[0].back()) / (w[2].back() - w[1].back());
  c.order = std::clamp(std::log2(std::max(ratio, 1e-3)), 0.5, 4.0);
  c.axis_mm = w[2];
  for (std::size_t i = 0; i < c.axis_mm.size(); ++i) {
    const double change = (w[2][i] - w[1][i]) / (std::exp2(c.order) - 1.0);
    c.axis_mm[i] += change;
    c.uncertainty_mm = std::max(c.uncertainty_mm, std::abs(change));
  }
  return c;
}

std::string BeamStudy::summary() const {
  std::ostringstream t;
  t.precision(4);
  t << std::fixed;
  t << "beam 50 x 10 x 10 mm, E 12 kPa, Poisson's ratio " << options.poisson << ", distributed load " << 1e3 * load_N_m
    << " mN/m along the height\n"
    << "  converged 3-D, clamped     tip " << clamped.axis_mm.back() << " mm, uncertain by " << clamped.uncertainty_mm
    << " (" << clamped.grid << ", extrapolated at order " << clamped.order << ")\n"
    << "  Euler-Bernoulli            tip " << eulerBernoulliTip_mm << " mm; 3-D lies " << std::showpos
    << gapEulerBernoulliTip_mm << std::noshowpos << " at the tip, at most " << gapEulerBernoulliAxis_mm
    << " along the axis: a difference of theories, whatever the method\n"
    << "  Timoshenko                 tip " << timoshenkoTip_mm << " mm; 3-D with the Poisson-free root lies "
    << std::showpos << gapTimoshenkoTip_mm << std::noshowpos << "\n"
    << "  allowed                    " << allowed_mm << " mm (1 % of a 1.64 mm voxel)\n"
    << "goals, at 1 mm tip, against the converged 3-D solution\n";
  for (const BeamGoal& g : goals) t << "  " << g.line() << "\n";
  return t.str();
}

std::string BeamStudy::caption() const {
  std::ostringstream t;
  t.precision(4);
  t << std::fixed << "Beam 50 x 10 x 10 mm, E 12 kPa, Poisson's ratio " << options.poisson
    << ". Error: largest along the axis against the converged 3-D solution (tip " << clamped.axis_mm.back()
    << " mm, uncertain by " << clamped.uncertainty_mm << "). Euler-Bernoulli's tip is " << eulerBernoulliTip_mm
    << " mm: 3-D lies " << std::showpos << gapEulerBernoulliTip_mm << std::noshowpos
    << " mm from it, whatever the method.";
  return t.str();
}

BeamStudy studyBeam(const BeamOptions& options, const Progress& progress) {
  BeamStudy study;
  study.options = options;
  const mechanics::Cantilever beam = validationBeam(options.poisson);
  study.load_N_m = mechanics::loadForTip_N_m(beam, 1e-3 * options.tip_mm);
  study.clamped = convergedBeam(options, Root::Clamped, options.quick ? 12 : 24, progress.part(0.0, 0.15));
  study.poissonFree = convergedBeam(options, Root::PoissonFree, 12, progress.part(0.15, 0.2));

  const std::vector<double> eb = stations(beam, study.load_N_m, false);
  const std::vector<double> timo = stations(beam, study.load_N_m, true);
  study.eulerBernoulliTip_mm = eb.back();
  study.timoshenkoTip_mm = timo.back();
  study.gapEulerBernoulliTip_mm = study.clamped.axis_mm.back() - eb.back();
  study.gapEulerBernoulliAxis_mm = largestDifference(study.clamped.axis_mm, eb);
  study.gapTimoshenkoTip_mm = study.poissonFree.axis_mm.back() - timo.back();

  study.goals = beamGoals(options.quick ? std::vector<double>{options.poisson} : std::vector<double>{0.3, 0.45, 0.49},
                          progress.part(0.2, 0.35));
  std::vector<BeamMethod> methods = beamMethods(options);
  std::vector<Row> byTheory[3];
  double work = 0.0, done = 0.0;
  for (const BeamMethod& m : methods) work += m.weight;
  for (const BeamMethod& m : methods) {
    const Progress part = progress.part(0.35 + 0.65 * done / work, 0.35 + 0.65 * (done + m.weight) / work);
    part.report(0.0, m.name);
    const BeamAnswer clamped = m.run(Root::Clamped, part.part(0.0, 0.5));
    const BeamAnswer free = m.run(Root::PoissonFree, part.part(0.5, 1.0));
    byTheory[0].push_back(against(clamped, study.clamped.axis_mm, converged3d));
    byTheory[1].push_back(against(free, timo, timoshenko));
    byTheory[2].push_back(against(clamped, eb, eulerBernoulli));
    done += m.weight;
  }
  for (std::vector<Row>& rows : byTheory) study.rows.insert(study.rows.end(), rows.begin(), rows.end());
  markPareto(study.rows);
  progress.report(1.0, "beam study done");
  return study;
}

}  // namespace glisson::study
