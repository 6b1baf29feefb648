#include "study/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "pipeline/run.h"
#include "retraction/discretisation.h"
#include "study/timing.h"

namespace glisson::study {
namespace {

using mechanics::HexElement;
using retraction::ModelKind;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// One way to answer the scene: cells coarser by a factor, and a setup.
struct Variant {
  std::string method;
  double factor = 1.0;
  std::function<void(retraction::Setup&)> change;
  std::string also{};  ///< goes behind the resolution
};

std::vector<Variant> variants(bool quick, std::size_t cells) {
  std::vector<Variant> all;
  const auto element = [](HexElement e, double tolerance) {
    return [=](retraction::Setup& s) {
      s.model.kind = ModelKind::FemHex;
      s.model.element = e;
      s.solver = {};
      if (tolerance > 0) {
        s.solver.kind = mechanics::SolverKind::Multigrid;
        s.solver.tolerance = tolerance;
      }
    };
  };
  const std::vector<double> factors = quick ? std::vector<double>{1, 2, 3} : std::vector<double>{1, 1.5, 2, 3, 4};
  for (const auto& [name, e] : {std::pair<const char*, HexElement>{"H8-incompatible", HexElement::Incompatible},
                                {"H8-Bbar", HexElement::BBar},
                                {"H8", HexElement::H8}})
    for (const double f : factors) all.push_back({name, f, element(e, 0)});
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-5}) {
    std::ostringstream also;
    also << ", tolerance " << tolerance;
    all.push_back({"H8-incompatible, looser", 1, element(HexElement::Incompatible, tolerance), also.str()});
  }
  const auto frames = [](mechanics::Kernel kernel, int order, int count, bool published) {
    return [=](retraction::Setup& s) {
      s.model.kind = ModelKind::Meshfree;
      s.model.element = HexElement::Incompatible;
      s.model.meshfree.kernel = kernel;
      s.model.meshfree.order = order;
      s.model.meshfree.frames = count;
      s.solver = {};
      if (!published) return;
      s.solver.kind = mechanics::SolverKind::Cg;
      s.solver.preconditioner = mechanics::Preconditioner::None;
      s.solver.iterations = 200;
    };
  };
  // Many frames on many cells cost minutes; the trend is seen with fewer.
  const bool few = quick || cells > 60000;
  for (const int n : few ? std::vector<int>{25, 50} : std::vector<int>{25, 50, 100, 200}) {
    all.push_back({"Wendland affine", 1, frames(mechanics::Kernel::Wendland, 1, n, false)});
    all.push_back({"Voronoi, CG 200 (published)", 1, frames(mechanics::Kernel::Voronoi, 1, n, true)});
  }
  for (const int n : few ? std::vector<int>{10, 20} : std::vector<int>{10, 20, 40, 80})
    all.push_back({"Wendland quadratic", 1, frames(mechanics::Kernel::Wendland, 2, n, false)});
  return all;
}

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

std::string cellsText(const retraction::Model& model) {
  const Eigen::Vector3d& s = model.youngs_kPa.grid.spacing_mm;
  std::ostringstream t;
  t.precision(3);
  t << model.cells << " cells of ";
  if ((s.array() - s.x()).abs().maxCoeff() < 1e-6)
    t << s.x() << " mm";
  else
    t << s.x() << "x" << s.y() << "x" << s.z() << " mm";
  return t.str();
}

void compare(Row& row, const std::vector<Eigen::Vector3d>& u, const std::vector<Eigen::Vector3d>& reference) {
  double largest = -1.0, sum = 0.0, moved = -1.0;
  std::size_t n = 0;
  row.tip_error_mm = none;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double d = (u[i] - reference[i]).norm();
    if (!std::isfinite(d)) continue;
    largest = std::max(largest, d);
    sum += d;
    ++n;
    if (reference[i].norm() > moved) {
      moved = reference[i].norm();
      row.tip_error_mm = d;
    }
  }
  row.max_error_mm = n > 0 ? largest : none;
  row.mean_error_mm = n > 0 ? sum / static_cast<double>(n) : none;
  if (n < u.size())
    row.note += (row.note.empty() ? "" : "; ") + std::to_string(u.size() - n) + " of " + std::to_string(u.size()) +
                " points lie outside this body";
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
  const pipeline::RunResult base = pipeline::run(own, {}, progress.part(0.05, 0.1), &inputs);
  scene.setup = held(scene.setup, base.model, base.primary);
  const std::vector<Eigen::Vector3d> points = comparedPoints(base.model, 20000);
  study.points = points.size();

  // The reference.
  progress.report(0.1, "reference");
  retraction::Setup best = held(own.setup, base.model, base.primary);
  best.solver.tolerance = 1e-9;
  const bool split = 8 * base.model.cells <= static_cast<std::size_t>(options.referenceCells);
  const retraction::Model fine = split ? refined(base.model) : base.model;
  const Stopwatch watch;
  const retraction::Result truth = retraction::simulate(fine, best, {}, progress.part(0.1, 0.25));
  study.reference_s = watch.seconds();
  study.referenceDofs = truth.dofs;
  study.reference = "H8-incompatible, " + cellsText(fine) + (split ? "" : " (splitting them would pass the budget)");
  if (!truth.solver.converged())
    throw SolverFailed("the reference of the scene did not converge, so nothing can be compared with it",
                       truth.solver.iterations, truth.solver.residual, best.solver.tolerance);
  const std::vector<Eigen::Vector3d> reference = retraction::displacementAt(fine, truth, points);
  for (const Eigen::Vector3d& u : reference)
    if (u.allFinite()) study.largest_mm = std::max(study.largest_mm, u.norm());

  const std::vector<Variant> all = variants(options.quick, base.model.cells);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Variant& v = all[i];
    const double n = static_cast<double>(all.size());
    const Progress part =
        progress.part(0.25 + 0.75 * static_cast<double>(i) / n, 0.25 + 0.75 * static_cast<double>(i + 1) / n);
    part.report(0.0, v.method);
    pipeline::Scene one = scene;
    v.change(one.setup);
    if (v.factor != 1.0) one.geometry.cell_mm = v.factor * base.model.youngs_kPa.grid.spacing_mm;
    try {
      const Stopwatch total;
      const pipeline::RunResult r = pipeline::run(one, {}, part, &inputs);
      const double seconds = total.seconds();
      Row row;
      row.method = v.method;
      row.resolution = cellsText(r.model) + v.also;
      if (one.setup.model.kind == ModelKind::Meshfree)
        row.resolution = std::to_string(r.primary.dofs / (one.setup.model.meshfree.order == 1 ? 12 : 30)) +
                         " frames on " + row.resolution;
      row.dofs = r.primary.dofs;
      row.solve_s = std::min(r.primary.solver.seconds, seconds);
      row.build_s = seconds - row.solve_s;
      row.step_ms = r.primary.steps > 0 ? 1e3 * seconds / r.primary.steps : none;
      row.reference = study.reference;
      row.converged = r.primary.solver.converged();
      if (!row.converged) row.note = r.primary.validity.empty() ? "not converged" : r.primary.validity.front();
      compare(row, retraction::displacementAt(r.model, r.primary, points), reference);
      study.rows.push_back(std::move(row));
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& e) {
      std::ostringstream why;
      why << v.method << ", cells x " << v.factor << ": " << e.what();
      study.skipped.push_back(why.str());
    }
  }
  markPareto(study.rows);
  progress.report(1.0, "trade-off done");
  return study;
}

}  // namespace glisson::study
