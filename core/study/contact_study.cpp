// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/contact_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/atomic_file.h"
#include "mechanics/contact/contact_solve.h"
#include "mechanics/measures.h"
#include "mechanics/static_solve.h"
#include "study/detail/timing.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;
using mechanics::SolidLaw;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A box of cubes whose floor y = 0 is held, and samples of its face y+ as scenes have them, 1.5 mm and half an edge
/// apart at most.
mechanics::ContactProblem onFloor(const Vector3d& size_mm, double h_mm, double E_Pa, double poisson) {
  mechanics::ContactProblem p;
  mechanics::VoxelBody& body = p.problem.body;
  body.cells = (size_mm / h_mm).array().round().cast<int>();
  body.h_m = Vector3d::Constant(1e-3 * h_mm);
  body.poisson = poisson;
  body.E_Pa.assign(static_cast<std::size_t>(body.cells.prod()), E_Pa);
  const mechanics::VoxelMesh mesh(body);
  p.problem.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).y() == 0) p.problem.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
  const int parts = std::max(2, static_cast<int>(std::ceil(h_mm / 1.5)));
  const double part = body.h_m.x() / parts, top = body.h_m.y() * body.cells.y();
  for (int k = 0; k < parts * body.cells.z(); ++k)
    for (int i = 0; i < parts * body.cells.x(); ++i)
      p.surface.push_back({{(i + 0.5) * part, top, (k + 0.5) * part}, Vector3d::UnitY(), part * part});
  return p;
}

std::string nameOf(SolidLaw law) {
  return law == SolidLaw::Linear       ? "rigid bar, linear"
         : law == SolidLaw::Polynomial ? "polynomial neo-Hookean"
                                       : "logarithmic neo-Hookean";
}

/// Solves and begins the row; the errors are still to be filled in.
Row solved(const mechanics::ContactProblem& p, const mechanics::ContactOptions& options, const char* reference,
           mechanics::ContactSolution& s, const Progress& progress) {
  const Stopwatch watch;
  s = mechanics::solveContact(p, options, progress);
  Row r;
  r.solve_s = watch.seconds();
  r.method = nameOf(p.law);
  const Eigen::Vector3i& c = p.problem.body.cells;
  std::ostringstream text;
  text.precision(3);
  text << c.x() << "x" << c.y() << "x" << c.z() << " (" << 1e3 * p.problem.body.h_m.x() << " mm)";
  r.resolution = text.str();
  r.dofs = static_cast<int>(3 * s.solution.u_m.cols());
  r.step_ms = none;
  r.reference = reference;
  r.converged = s.solution.report.converged();
  if (!r.converged) r.note = mechanics::describe(s.solution.report.status);
  r.max_error_mm = r.tip_error_mm = r.mean_error_mm = none;
  return r;
}

/// Plane strain: one layer of cells whose nodes stay in their planes.
Row onHertz(double h_mm, const Progress& progress) {
  constexpr double E = 10e3, nu = 0.3, R = 5e-3, a = 1e-3;
  const double line_N_m = std::numbers::pi * E * a * a / (4 * R * (1 - nu * nu)), thick = 1e-3 * h_mm;
  mechanics::ContactProblem p = onFloor({40, 20, h_mm}, h_mm, E, nu);
  const mechanics::VoxelMesh mesh(p.problem.body);
  p.problem.supports.fixations.clear();
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const bool floor = mesh.latticeOf(n).y() == 0;
    p.problem.supports.fixations.push_back({n, {floor, floor, true}, {0, 0, 0}});
  }
  p.law = SolidLaw::Linear;
  p.bar = mechanics::RigidBar{{{0.02, 0.03, -0.02}, {0.02, 0.03, 0.02}}, R, {0, -1, 0}};
  p.force_N = line_N_m * thick;
  mechanics::ContactOptions options;
  options.zone_m = 0.02e-3;
  mechanics::ContactSolution s;
  Row r = solved(p, options, hertz, s, progress);
  if (!r.converged) return r;
  double force = 0, second = 0;
  for (std::size_t i = 0; i < p.surface.size(); ++i) {
    const double f = s.pressure_Pa[i] * p.surface[i].area_m2, x = p.surface[i].p_m.x() - 0.02;
    force += f;
    second += f * x * x;
  }
  // An elliptic pressure has the second moment a²/4 and the largest value 2 F / (π a).
  r.max_error_mm = 1e3 * std::abs(2 * std::sqrt(second / force) - a);
  r.tip_error_mm = 1e3 * std::abs(2 * line_N_m / (std::numbers::pi * s.pressureMax_Pa) - a);
  r.mean_error_mm = r.max_error_mm;
  return r;
}

Row onBlock(double h_mm, SolidLaw law, const Progress& progress) {
  constexpr std::array<std::array<double, 2>, 3> depths_mm = {{{60, 11.7}, {40, 5.27}, {20, 1.78}}};  // at y, moved by
  mechanics::ContactProblem p = onFloor({160, 60, 100}, h_mm, 6090, 0.45);
  p.law = law;
  p.bar = mechanics::RigidBar{{{0.04, 0.09, 0.05}, {0.12, 0.09, 0.05}}, 0.005, {0, -1, 0}};
  p.force_N = 4.6;
  mechanics::ContactSolution s;
  Row r = solved(p, {}, calculix, s, progress);
  if (!r.converged) return r;
  r.max_error_mm = r.mean_error_mm = 0;
  const mechanics::VoxelMesh mesh(p.problem.body);
  for (const auto& [y_mm, wanted_mm] : depths_mm) {
    const auto u = mechanics::displacementAt(mesh, s.solution.u_m, {0.08, 1e-3 * y_mm, 0.05});
    const double off = u ? std::abs(-1e3 * u->y() - wanted_mm) : none;
    if (y_mm == depths_mm[0][0]) r.tip_error_mm = off;
    r.max_error_mm = std::max(r.max_error_mm, off);
    r.mean_error_mm += off / static_cast<double>(depths_mm.size());
  }
  return r;
}

Row onCantilever(double h_mm, SolidLaw law, const Progress& progress) {
  constexpr double length_mm = 100, side_mm = 5, E = 12e3, load = 4;
  mechanics::ContactProblem p = onFloor({length_mm, side_mm, side_mm}, h_mm, E, 0);
  p.law = law;
  const mechanics::VoxelMesh mesh(p.problem.body);
  const Eigen::Vector3i& cells = p.problem.body.cells;
  const double inertia = std::pow(1e-3 * side_mm, 4) / 12;
  const double force_N = load * E * inertia / std::pow(1e-3 * length_mm, 2);
  p.problem.supports.fixations.clear();
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const Eigen::Vector3i at = mesh.latticeOf(n);
    if (at.x() == 0) p.problem.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
    const auto share = [](int i, int last) { return i == 0 || i == last ? 0.5 / last : 1.0 / last; };
    if (at.x() == cells.x()) p.problem.f_N(1, n) = force_N * share(at.y(), cells.y()) * share(at.z(), cells.z());
  }
  mechanics::ContactSolution s;
  Row r = solved(p, {}, elastica, s, progress);
  if (!r.converged) return r;
  const ElasticaTip tip = elasticaTip(load);
  const Vector3d middle(1e-3 * length_mm, 0.5e-3 * side_mm, 0.5e-3 * side_mm);
  const Vector3d u = 1e3 * mechanics::displacementAt(mesh, s.solution.u_m, middle).value_or(Vector3d::Constant(none));
  r.max_error_mm = std::hypot(u.x() - (tip.along - 1) * length_mm, u.y() - tip.across * length_mm);
  r.tip_error_mm = std::abs(u.y() - tip.across * length_mm);
  r.mean_error_mm = r.max_error_mm;
  return r;
}

}  // namespace

ElasticaTip elasticaTip(double load) {
  struct State {
    double theta, curvature, along, across;
  };
  constexpr int steps = 2000;
  const auto shot = [&](double curvature) {
    State s{0, curvature, 0, 0};
    const auto rate = [&](const State& q) {
      return State{q.curvature, -load * std::cos(q.theta), std::cos(q.theta), std::sin(q.theta)};
    };
    const auto moved = [](const State& q, const State& d, double h) {
      return State{q.theta + h * d.theta, q.curvature + h * d.curvature, q.along + h * d.along,
                   q.across + h * d.across};
    };
    constexpr double h = 1.0 / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(moved(s, a, h / 2)), c = rate(moved(s, b, h / 2)), d = rate(moved(s, c, h));
      for (const auto& [k, w] : {std::pair{a, 1.0}, {b, 2.0}, {c, 2.0}, {d, 1.0}}) s = moved(s, k, w * h / 6);
    }
    return s;
  };
  // The free end bears no moment: its curvature vanishes. It grows with the curvature at the root.
  double low = 0, high = load;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (shot(middle).curvature > 0 ? high : low) = middle;
  }
  const State end = shot(0.5 * (low + high));
  return {end.along, end.across};
}

ContactStudy studyContact(const ContactStudyOptions& options, const Progress& progress) {
  ContactStudy study;
  std::vector<std::function<Row(const Progress&)>> tasks;
  for (const double h : {0.5, 0.25, 0.125})
    if (!options.quick || h > 0.2) tasks.push_back([h](const Progress& p) { return onHertz(h, p); });
  for (const SolidLaw law : {SolidLaw::Polynomial, SolidLaw::Logarithmic}) {
    for (const double h : {10.0, 5.0, 4.0, 10.0 / 3, 2.5})
      if (!options.quick || h > 4.5) tasks.push_back([h, law](const Progress& p) { return onBlock(h, law, p); });
    for (const double h : {2.5, 1.25, 0.625})
      if (!options.quick || h > 1) tasks.push_back([h, law](const Progress& p) { return onCantilever(h, law, p); });
  }
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const auto n = static_cast<double>(tasks.size());
    study.rows.push_back(tasks[i](progress.part(static_cast<double>(i) / n, (static_cast<double>(i) + 1) / n)));
  }
  std::stable_sort(study.rows.begin(), study.rows.end(), [](const Row& a, const Row& b) {
    const auto place = [](const Row& r) { return r.reference == hertz ? 0 : r.reference == calculix ? 1 : 2; };
    return place(a) < place(b);
  });
  markPareto(study.rows);
  return study;
}

std::string ContactStudy::summary() const {
  return "Hertz: a rigid cylinder of 5 mm radius on a half plane, half width 1 mm; linear, plane strain\n"
         "CalculiX: a rigid bar of 10 x 80 mm with 4.6 N on a block of 160 x 60 x 100 mm, E 6.09 kPa, Poisson's ratio "
         "0.45: 11.7, 5.27 and 1.78 mm under it, 20 and 40 mm below\n"
         "Elastica: a cantilever of 100 x 5 x 5 mm, dead force at its end, P L^2 / (E I) = 4, Poisson's ratio 0; the "
         "solid also shears and stretches, which the elastica does not\n";
}

std::vector<std::filesystem::path> writeContactStudy(const std::filesystem::path& folder, const ContactStudy& study) {
  struct Shown {
    const char *reference, *name, *title;
  };
  constexpr std::array<Shown, 3> charts = {{{hertz, "validate-contact-hertz", "Line contact against Hertz"},
                                            {calculix, "validate-contact-block", "Bar on a block against CalculiX"},
                                            {elastica, "validate-contact-elastica", "Bending against the elastica"}}};
  std::filesystem::create_directories(folder);
  writeAtomically(folder / "validate-contact.csv", csv(study.rows));
  std::vector<std::filesystem::path> files = {folder / "validate-contact.csv"};
  for (const Shown& c : charts)
    for (auto& file : writeChart(folder, c.name, chart(study.rows, c.reference, c.title, {})))
      files.push_back(std::move(file));
  return files;
}

}  // namespace glisson::study
