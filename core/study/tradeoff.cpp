// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tradeoff.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "pipeline/run.h"
#include "retraction/discretisation.h"
#include "study/detail/compared.h"
#include "study/detail/time_schemes.h"
#include "study/detail/timing.h"
#include "study/detail/tradeoff_runs.h"
#include "study/detail/tradeoff_variants.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using retraction::ModelKind;

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

/// The scene's own bar, whose patch the other methods carry: the same place on all cells.
void addBar(retraction::Setup setup, const pipeline::RunResult& base, retraction::Model fine,
            const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options, TradeoffRuns& tradeoff,
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

/// Displacement only: no comparison, nothing to draw.
pipeline::Scene displacementOf(pipeline::Scene scene) {
  scene.compare.reset();
  scene.outputs = {};
  scene.outputs.displacementField = true;
  return scene;
}

pipeline::Inputs inputsOf(const pipeline::Scene& scene, const Progress& progress) {
  if (scene.geometry.kind == pipeline::GeometrySpec::Kind::Box &&
      scene.material.kind != pipeline::MaterialSpec::Kind::Map)
    return {};
  return pipeline::loadInputs(scene, progress);
}

/// On the voxel elements with incompatible modes, solved as exactly as the software can.
pipeline::Scene onBestElements(pipeline::Scene scene) {
  scene.setup.model.kind = ModelKind::FemHex;
  scene.setup.model.element = HexElement::Incompatible;
  scene.setup.solver = {};
  return scene;
}

struct Reference {
  retraction::Model model;         ///< on finer cells than the scene's where the budget of cells allows it
  std::vector<Eigen::Vector3d> u;  ///< at the compared points, mm
};

/// Solves the reference and says in the study what it is. base: the scene on its own cells.
/// Throws SolverFailed.
Reference solveReference(const retraction::Setup& setup, const pipeline::RunResult& base,
                         const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options,
                         TradeoffStudy& study, const Progress& progress) {
  retraction::Setup best = retraction::withPatch(held(setup, base.model, base.primary));
  best.solver.tolerance = 1e-9;
  const bool split = 8 * base.model.cells <= static_cast<std::size_t>(options.referenceCells);
  Reference reference{split ? refined(base.model) : base.model, {}};
  const Stopwatch watch;
  const retraction::Result truth = retraction::simulate(reference.model, best, {}, progress);
  study.reference_s = watch.seconds();
  study.referenceDofs = truth.dofs;
  study.reference = "H8-incompatible, " + cellsText(reference.model) +
                    (split ? "" : " (splitting them would pass the budget)") +
                    (base.primary.contact ? ", the rigid bar as a patch of pressure" : "");
  if (!truth.solver.converged())
    throw SolverFailed("the reference of the scene did not converge, so nothing can be compared with it",
                       truth.solver.iterations, truth.solver.residual, best.solver.tolerance);
  reference.u = retraction::displacementAt(reference.model, truth, points);
  for (const Eigen::Vector3d& u : reference.u)
    if (u.allFinite()) study.largest_mm = std::max(study.largest_mm, u.norm());
  return reference;
}

/// One row after the other until the budget is spent; the rest is named.
void runVariants(TradeoffRuns& tradeoff, const std::vector<Variant>& all, double budget_s, TradeoffStudy& study,
                 const Progress& progress) {
  const Stopwatch budget;
  const double n = static_cast<double>(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Progress part = progress.part(static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
    part.report(0.0, all[i].method);
    if (budget.seconds() > budget_s) {
      std::ostringstream why;
      why << all.size() - i << " further variants, from \"" << all[i].method << "\" on: the budget of " << budget_s
          << " s was spent";
      study.skipped.push_back(why.str());
      break;
    }
    // The variant's own messages would pass by faster than one can read.
    tradeoff.run(all[i], Progress([&part](double, const std::string&) { part.check(); }));
  }
}

/// The bar's rows first, then those against the reference, then linear theory's, then the schemes in time; each with
/// its Pareto front.
void arrange(TradeoffStudy& study) {
  const auto rank = [&](const Row& r) {
    for (const TradeoffStudy::Family& f : study.families)
      if (f.reference == r.reference) return f.name == "bar" ? 0 : 3;
    return r.reference == study.reference ? 1 : 2;
  };
  std::stable_sort(study.rows.begin(), study.rows.end(), [&](const Row& a, const Row& b) { return rank(a) < rank(b); });
  markPareto(study.rows);
  for (Row& r : study.rows)
    if (r.reference == linearTheory) r.pareto = false;  // alone with its reference
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
  pipeline::Scene scene = displacementOf(asked);
  const pipeline::Inputs inputs = inputsOf(scene, progress.part(0.0, 0.05));
  TradeoffStudy study;
  const pipeline::Scene own = onBestElements(scene);
  progress.report(0.05, "the scene at its own resolution");
  const pipeline::RunResult base =
      pipeline::run(own, {.output = {}, .discretisation = false}, progress.part(0.05, 0.1), &inputs);
  scene.setup = held(scene.setup, base.model, base.primary);
  const std::vector<Eigen::Vector3d> points = comparedPoints(base.model, 20000);
  study.points = points.size();

  progress.report(0.1, "reference");
  const Reference reference = solveReference(own.setup, base, points, options, study, progress.part(0.1, 0.25));
  TradeoffRuns tradeoff(scene, inputs, base.model, points, reference.u, study);
  runVariants(tradeoff,
              tradeoffVariants(options.quick, base.model.cells, static_cast<int>(base.primary.nodal_u_m.cols()),
                               scene.setup.seed, study.skipped),
              options.budget_s, study, progress.part(0.25, 1.0));
  const Progress quiet([&progress](double, const std::string&) { progress.check(); });
  progress.report(0.9, "what the scene adds");
  if (base.primary.contact && base.placed)
    addBar(own.setup, base, reference.model, points, options, tradeoff, study, quiet);
  if (scene.setup.analysis.dynamic) addTimeSchemes(base.model, scene.setup, points, options, study, quiet);
  arrange(study);
  progress.report(1.0, "trade-off done");
  return study;
}

}  // namespace glisson::study
