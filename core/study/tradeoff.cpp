#include "study/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "base/error.h"
#include "pipeline/run.h"
#include "retraction/body.h"
#include "retraction/discretisation.h"
#include "study/compared.h"
#include "study/methods.h"
#include "study/time_schemes.h"
#include "study/timing.h"
#include "study/tradeoff_variants.h"

namespace glisson::study {
namespace {

/// The scene with its loads on nodes, which every method can carry.
pipeline::Scene onNodes(pipeline::Scene scene) {
  scene.setup = retraction::withPatch(std::move(scene.setup));
  return scene;
}

using mechanics::HexElement;
using retraction::ModelKind;
constexpr const char* rigidBarMethod = "Rigid bar, large deformation";
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The scene's body in cells of one size.
struct Case {
  retraction::Model model;
  std::unique_ptr<retraction::Body> body;
  retraction::MechanicsScene scene;
  std::string failed;  ///< why there is none
  std::string sameAs;  ///< the size that came to the same grid
};

/// Up to `most` cell centres, evenly through the list.
std::vector<Eigen::Vector3d> comparedPoints(const retraction::Model& model, std::size_t most) {
  const image::Grid& g = model.youngs_kPa.grid;
  std::vector<Eigen::Vector3d> points;
  const std::size_t stride = std::max<std::size_t>(1, (model.cells + most - 1) / most);
  std::size_t n = 0;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        if (model.youngs_kPa.at(i, j, k) > 0 && n++ % stride == 0)
          points.push_back(g.indexToLps(Eigen::Vector3d(i, j, k)));
  return points;
}

/// The study's state: cases by cell size, rows so far.
class Tradeoff {
 public:
  Tradeoff(pipeline::Scene scene, const pipeline::Inputs& inputs, const retraction::Model& own,
           std::vector<Eigen::Vector3d> points, std::vector<Eigen::Vector3d> truth, TradeoffStudy& study)
      : scene_(onNodes(std::move(scene))),
        inputs_(inputs),
        own_(own),
        points_(std::move(points)),
        truth_(std::move(truth)),
        study_(study) {}

  /// Adds the variant's row, or says why there is none.
  void run(const Variant& v, const Progress& progress) {
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

  /// The rigid bar in large deformation on cells of this size, against the same on the reference's cells.
  void runBar(double factor, const retraction::Setup& setup, const std::vector<Eigen::Vector3d>& truth,
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

 private:
  Case& at(double factor, const Progress& progress) {
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

  /// Through the whole retraction step: tetrahedra, and scenes that move or are not linear.
  Measured simulated(const Variant& v, const Case& c, const Progress& progress) const {
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

  Measured measured(const Variant& v, const Case& c, const Progress& progress) const {
    const bool plain = scene_.setup.kinematics == retraction::Kinematics::Linear && !scene_.setup.analysis.dynamic;
    if (!plain || v.kind == Variant::Kind::Tetrahedra || v.kind == Variant::Kind::Corotational)
      return simulated(v, c, progress);
    // A step on many cells takes as long as a solve.
    const int steps = c.model.cells <= 30000 ? 3 : 0;
    if (v.kind == Variant::Kind::Frames) return measureFrames(c.scene.problem, v.meshfree, v.solver, steps, progress);
    if (v.kind == Variant::Kind::Condensed) return measureCondensed(c.scene.problem, c.scene.loads_N, steps, progress);
    return measureVoxels(c.scene.problem, v.solver, v.solver.kind == mechanics::SolverKind::Auto ? steps : 0, progress);
  }

  std::vector<Eigen::Vector3d> atPoints(const Case& c, const mechanics::NodalField& u_m) const {
    retraction::Result r;
    r.nodal_u_m = u_m;
    return retraction::displacementAt(c.model, r, points_);
  }

  /// What the solver alone leaves: the distance from the exact answer of the same cells.
  void noteSolver(const Variant& v, const Measured& m, const std::vector<Eigen::Vector3d>& u, Row& row) {
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
    t << (row.note.empty() ? "" : "; ") << "the solver leaves " << worst << " mm after " << m.iterations
      << " iterations";
    row.note += t.str();
  }

  Row answer(const Variant& v, Case& c, const Progress& progress) {
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

  pipeline::Scene scene_;
  const pipeline::Inputs& inputs_;
  const retraction::Model& own_;
  std::vector<Eigen::Vector3d> points_, truth_;
  std::vector<Eigen::Vector3d> exact_;  ///< of the scene's own cells
  TradeoffStudy& study_;
  std::map<double, Case> cases_;
};

/// The scene's own bar, whose patch the other methods carry: the same place on all cells.
void addBar(retraction::Setup setup, const pipeline::RunResult& base, retraction::Model fine,
            const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options, Tradeoff& tradeoff,
            TradeoffStudy& study, const Progress& progress) {
  for (retraction::LoadSpec& load : setup.loads)
    if (auto* bar = std::get_if<retraction::Retractor>(&load)) *bar = base.placed->bar;
  fine.smooth = base.model.smooth;
  const retraction::Result finest = retraction::simulate(fine, setup, {}, progress);
  if (!finest.solver.converged()) {
    study.skipped.push_back(std::string(rigidBarMethod) + ": its reference did not converge");
    return;
  }
  const std::vector<Eigen::Vector3d> there = retraction::displacementAt(fine, finest, points);
  study.families.push_back({"bar", "rigid bar on " + cellsText(fine)});
  for (const double factor : options.quick ? std::vector<double>{2, 1} : std::vector<double>{3, 2, 1.5, 1})
    tradeoff.runBar(factor, setup, there, study.families.back().reference, progress);
}

void addTimeSchemes(const retraction::Model& model, const retraction::Setup& setup,
                    const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options, TradeoffStudy& study,
                    const Progress& progress) {
  std::vector<Row> rows = timeSchemeRows(model, setup, points, options, study.skipped, progress);
  if (rows.empty()) return;
  study.families.push_back({"time", rows.front().reference});
  for (Row& row : rows) study.rows.push_back(std::move(row));
}

}  // namespace

std::string TradeoffStudy::summary() const {
  std::ostringstream t;
  t.precision(4);
  t << "reference: " << reference << ", " << referenceDofs << " degrees of freedom in " << reference_s << " s; "
    << points << " points compared, the largest displacement among them " << largest_mm << " mm";
  return t.str();
}

TradeoffStudy studyTradeoff(const pipeline::Scene& asked, const TradeoffOptions& options, const Progress& progress) {
  // Displacement only: no comparison, nothing to draw.
  pipeline::Scene scene = asked;
  scene.compare.reset();
  scene.outputs = {};
  scene.outputs.displacementField = true;
  pipeline::Inputs inputs;
  if (scene.geometry.kind != pipeline::GeometrySpec::Kind::Box ||
      scene.material.kind == pipeline::MaterialSpec::Kind::Map)
    inputs = pipeline::loadInputs(scene, progress.part(0.0, 0.05));

  TradeoffStudy study;
  pipeline::Scene own = scene;
  own.setup.model.kind = ModelKind::FemHex;
  own.setup.model.element = HexElement::Incompatible;
  own.setup.solver = {};
  progress.report(0.05, "the scene at its own resolution");
  const pipeline::RunResult base =
      pipeline::run(own, {.output = {}, .discretisation = false}, progress.part(0.05, 0.1), &inputs);
  scene.setup = held(scene.setup, base.model, base.primary);
  const std::vector<Eigen::Vector3d> points = comparedPoints(base.model, 20000);
  study.points = points.size();

  // The reference.
  progress.report(0.1, "reference");
  retraction::Setup best = retraction::withPatch(held(own.setup, base.model, base.primary));
  best.solver.tolerance = 1e-9;
  const bool split = 8 * base.model.cells <= static_cast<std::size_t>(options.referenceCells);
  const retraction::Model fine = split ? refined(base.model) : base.model;
  const Stopwatch watch;
  const retraction::Result truth = retraction::simulate(fine, best, {}, progress.part(0.1, 0.25));
  study.reference_s = watch.seconds();
  study.referenceDofs = truth.dofs;
  study.reference = "H8-incompatible, " + cellsText(fine) + (split ? "" : " (splitting them would pass the budget)") +
                    (base.primary.contact ? ", the rigid bar as a patch of pressure" : "");
  if (!truth.solver.converged())
    throw SolverFailed("the reference of the scene did not converge, so nothing can be compared with it",
                       truth.solver.iterations, truth.solver.residual, best.solver.tolerance);
  const std::vector<Eigen::Vector3d> reference = retraction::displacementAt(fine, truth, points);
  for (const Eigen::Vector3d& u : reference)
    if (u.allFinite()) study.largest_mm = std::max(study.largest_mm, u.norm());

  Tradeoff tradeoff(scene, inputs, base.model, points, reference, study);
  const std::vector<Variant> all =
      tradeoffVariants(options.quick, base.model.cells, static_cast<int>(base.primary.nodal_u_m.cols()),
                       scene.setup.seed, study.skipped);
  const Stopwatch budget;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double n = static_cast<double>(all.size());
    const Progress part =
        progress.part(0.25 + 0.75 * static_cast<double>(i) / n, 0.25 + 0.75 * static_cast<double>(i + 1) / n);
    part.report(0.0, all[i].method);
    if (budget.seconds() > options.budget_s) {
      std::ostringstream why;
      why << all.size() - i << " further variants, from \"" << all[i].method << "\" on: the budget of "
          << options.budget_s << " s was spent";
      study.skipped.push_back(why.str());
      break;
    }
    // The variant's own messages would pass by faster than one can read.
    tradeoff.run(all[i], Progress([&part](double, const std::string&) { part.check(); }));
  }
  const Progress quiet([&progress](double, const std::string&) { progress.check(); });
  progress.report(0.9, "what the scene adds");
  if (base.primary.contact && base.placed) addBar(own.setup, base, fine, points, options, tradeoff, study, quiet);
  if (scene.setup.analysis.dynamic) addTimeSchemes(base.model, scene.setup, points, options, study, quiet);
  const auto rank = [&](const Row& r) {
    for (const TradeoffStudy::Family& f : study.families)
      if (f.reference == r.reference) return f.name == "bar" ? 0 : 3;
    return r.reference == study.reference ? 1 : 2;
  };
  std::stable_sort(study.rows.begin(), study.rows.end(), [&](const Row& a, const Row& b) { return rank(a) < rank(b); });
  markPareto(study.rows);
  for (Row& r : study.rows)
    if (r.reference == linearTheory) r.pareto = false;  // alone with its reference
  progress.report(1.0, "trade-off done");
  return study;
}

}  // namespace glisson::study
