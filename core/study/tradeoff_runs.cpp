// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/tradeoff_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "study/detail/compared.h"
#include "study/detail/timing.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using retraction::ModelKind;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The scene with its loads on nodes, which every method can carry.
pipeline::Scene onNodes(pipeline::Scene scene) {
  scene.setup = retraction::withPatch(std::move(scene.setup));
  return scene;
}

}  // namespace

TradeoffRuns::TradeoffRuns(pipeline::Scene scene, const pipeline::Inputs& inputs, const retraction::Model& own,
                           std::vector<Eigen::Vector3d> points, std::vector<Eigen::Vector3d> truth,
                           TradeoffStudy& study)
    : scene_(onNodes(std::move(scene))),
      inputs_(inputs),
      own_(own),
      points_(std::move(points)),
      truth_(std::move(truth)),
      study_(study) {}

void TradeoffRuns::run(const Variant& v, const Progress& progress) {
  std::ostringstream name;
  name << v.method;
  if (v.factor != 1.0) name << ", cells x " << v.factor;
  if (v.kind == Variant::Kind::Frames) name << ", " << v.meshfree.frames << " frames";
  name << v.also << ": ";
  const auto skip = [&](const std::string& why) { study_.skipped.push_back(name.str() + why); };
  try {
    Case& c = at(v.factor, progress.part(0.0, 0.2));
    if (!c.failed.empty()) return skip(c.failed);
    if (!c.sameAs.empty()) return skip("the same grid as " + c.sameAs);
    if (v.mostCells > 0 && c.model.cells > v.mostCells)
      return skip(std::to_string(c.model.cells) + " cells would take minutes (limit " + std::to_string(v.mostCells) +
                  ")");
    Row row = answer(v, c, progress.part(0.2, 1.0));
    for (const Row& other : study_.rows)
      if (other.method == row.method && other.dofs == row.dofs && other.reference == row.reference &&
          std::abs(other.max_error_mm - row.max_error_mm) <= 1e-6 * other.max_error_mm)
        return skip("the same answer as " + other.resolution);
    // Lloyd's method finds room for fewer frames than the nodes alone would have.
    if (v.kind == Variant::Kind::Frames)
      for (const Row& other : study_.rows)
        if (other.method == row.method && row.dofs < 1.15 * other.dofs)
          return skip("the voxels had room for " + row.resolution + ", hardly more than above");
    study_.rows.push_back(std::move(row));
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    skip(e.what());
  }
}

void TradeoffRuns::runBar(double factor, const retraction::Setup& setup, const std::vector<Eigen::Vector3d>& truth,
                          const std::string& reference, const Progress& progress) {
  std::ostringstream name;
  name << rigidBarMethod << ", cells x " << factor << ": ";
  try {
    const Case& c = at(factor, progress.part(0.0, 0.2));
    if (!c.failed.empty() || !c.sameAs.empty()) {
      study_.skipped.push_back(name.str() + (c.failed.empty() ? "the same grid as " + c.sameAs : c.failed));
      return;
    }
    retraction::Model model = c.model;
    model.smooth = own_.smooth;
    const Stopwatch total;
    const retraction::Result r = retraction::simulate(model, setup, {}, progress.part(0.2, 1.0));
    Row row;
    row.method = rigidBarMethod;
    row.resolution = cellsText(model);
    row.dofs = r.dofs;
    row.solve_s = std::min(r.solver.seconds, total.seconds());
    row.build_s = total.seconds() - row.solve_s;
    row.step_ms = none;
    row.converged = r.solver.converged();
    row.note = ending(r.solver);
    row.reference = reference;
    compare(row, retraction::displacementAt(model, r, points_), truth);
    study_.rows.push_back(std::move(row));
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    study_.skipped.push_back(name.str() + e.what());
  }
}

TradeoffRuns::Case& TradeoffRuns::at(double factor, const Progress& progress) {
  const auto found = cases_.find(factor);
  if (found != cases_.end()) return found->second;
  Case& c = cases_[factor];
  try {
    if (factor == 1.0) {
      c.model = own_;
    } else {
      pipeline::Scene coarse = scene_;
      coarse.geometry.cell_mm = factor * own_.youngs_kPa.grid.spacing_mm;
      coarse.setup.model = {};
      coarse.setup.solver = {};
      c.model = pipeline::run(coarse, {.output = {}, .discretisation = false}, progress, &inputs_).model;
    }
    for (const auto& [other, before] : cases_)
      if (other != factor && before.failed.empty() && before.sameAs.empty() &&
          before.model.youngs_kPa.grid.sameGeometry(c.model.youngs_kPa.grid, 1e-9) &&
          before.model.youngs_kPa.values == c.model.youngs_kPa.values)
        c.sameAs = cellsText(before.model);
    c.body = std::make_unique<retraction::Body>(c.model);
    c.scene = retraction::toMechanics(*c.body, c.model, scene_.setup);
  } catch (const Cancelled&) {
    cases_.erase(factor);
    throw;
  } catch (const Error& e) {
    c.failed = e.what();
  }
  return c;
}

Measured TradeoffRuns::simulated(const Variant& v, const Case& c, const Progress& progress) const {
  retraction::Setup setup = scene_.setup;
  setup.solver = v.solver;
  setup.condensed = v.kind == Variant::Kind::Condensed;
  setup.model.kind = v.kind == Variant::Kind::Tetrahedra ? ModelKind::FemTet
                     : v.kind == Variant::Kind::Frames   ? ModelKind::Meshfree
                                                         : ModelKind::FemHex;
  setup.model.element = v.solver.element;
  setup.model.quadraticTets = v.quadraticTets;
  setup.model.meshfree = v.meshfree;
  if (v.kind == Variant::Kind::Corotational) setup.kinematics = retraction::Kinematics::Corotational;
  const Stopwatch total;
  retraction::Result r = retraction::simulate(c.model, setup, {}, progress);
  Measured m;
  const double seconds = total.seconds();
  m.solve_s = std::min(r.solver.seconds, seconds);
  m.build_s = seconds - m.solve_s;
  m.dofs = r.dofs;
  m.frames = r.frames;
  m.converged = r.solver.converged();
  m.note = ending(r.solver);
  if (r.steps > 0) m.step_ms = 1e3 * seconds / r.steps;
  m.u_m = std::move(r.nodal_u_m);
  return m;
}

Measured TradeoffRuns::measured(const Variant& v, const Case& c, const Progress& progress) const {
  const bool plain = scene_.setup.kinematics == retraction::Kinematics::Linear && !scene_.setup.analysis.dynamic;
  if (!plain || v.kind == Variant::Kind::Tetrahedra || v.kind == Variant::Kind::Corotational)
    return simulated(v, c, progress);
  // A step on many cells takes as long as a solve.
  const int steps = c.model.cells <= 30000 ? 3 : 0;
  if (v.kind == Variant::Kind::Frames) return measureFrames(c.scene.problem, v.meshfree, v.solver, steps, progress);
  if (v.kind == Variant::Kind::Condensed) return measureCondensed(c.scene.problem, c.scene.loads_N, steps, progress);
  return measureVoxels(c.scene.problem, v.solver, v.solver.kind == mechanics::SolverKind::Auto ? steps : 0, progress);
}

std::vector<Eigen::Vector3d> TradeoffRuns::atPoints(const Case& c, const mechanics::NodalField& u_m) const {
  retraction::Result r;
  r.nodal_u_m = u_m;
  return retraction::displacementAt(c.model, r, points_);
}

void TradeoffRuns::noteSolver(const Variant& v, const Measured& m, const std::vector<Eigen::Vector3d>& u, Row& row) {
  if (v.solver.kind == mechanics::SolverKind::Auto) {
    if (v.solver.element == HexElement::Incompatible) exact_ = u;
    return;
  }
  if (exact_.size() != u.size()) return;
  double worst = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double d = (u[i] - exact_[i]).norm();
    if (std::isfinite(d)) worst = std::max(worst, d);
  }
  std::ostringstream t;
  t.precision(2);
  t << (row.note.empty() ? "" : "; ") << "the solver leaves " << worst << " mm after " << m.iterations << " iterations";
  row.note += t.str();
}

Row TradeoffRuns::answer(const Variant& v, Case& c, const Progress& progress) {
  if (v.kind == Variant::Kind::Corotational && scene_.setup.kinematics != retraction::Kinematics::Linear)
    throw BadInput("the scene itself is not linear");
  const Measured m = quickest([&] { return measured(v, c, progress); });
  Row row;
  row.method = v.method;
  row.resolution = cellsText(c.model) + v.also;
  if (v.kind == Variant::Kind::Frames) row.resolution = std::to_string(m.frames) + " frames on " + row.resolution;
  row.dofs = m.dofs;
  row.build_s = m.build_s;
  row.solve_s = m.solve_s;
  row.step_ms = m.step_ms;
  row.converged = m.converged;
  row.note = m.note;
  row.reference = study_.reference;
  if (v.kind == Variant::Kind::Condensed) {
    row.online = true;
    row.note = "solve s is the online product; build s is spent once";
  }
  if (v.kind == Variant::Kind::Corotational) {
    Variant linear;
    const Measured straight = measured(linear, c, progress);
    row.reference = linearTheory;
    compare(row, atPoints(c, m.u_m), atPoints(c, straight.u_m));
  } else {
    const std::vector<Eigen::Vector3d> u = atPoints(c, m.u_m);
    compare(row, u, truth_);
    if (v.kind == Variant::Kind::Voxels && v.factor == 1.0) noteSolver(v, m, u, row);
  }
  return row;
}

}  // namespace glisson::study
