// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/time_schemes.h"

#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "study/detail/compared.h"
#include "study/detail/timing.h"

namespace glisson::study {
namespace {

using mechanics::TimeScheme;

constexpr double finest = 1.0 / 16;
constexpr int mostSteps = 40000;  ///< of the reference

const char* inWords(TimeScheme scheme) {
  switch (scheme) {
    case TimeScheme::Newmark: return "Newmark, average acceleration";
    case TimeScheme::GeneralisedAlpha: return "Generalised alpha";
    case TimeScheme::ImplicitEuler: break;
  }
  return "Implicit Euler";
}

retraction::Setup with(retraction::Setup setup, TimeScheme scheme, double factor) {
  setup.analysis.scheme = scheme;
  setup.analysis.h_ms *= factor;
  setup.analysis.stopWhenSteady = 0.0;
  return setup;
}

std::string stepsText(const retraction::Setup& setup) {
  std::ostringstream t;
  t.precision(4);
  t << "steps of " << setup.analysis.h_ms << " ms";
  return t.str();
}

Row rowOf(const retraction::Model& model, const retraction::Setup& setup, const std::vector<Eigen::Vector3d>& points,
          const std::vector<Eigen::Vector3d>& truth, const Progress& progress) {
  const Stopwatch watch;
  const retraction::Result r = retraction::simulate(model, setup, {}, progress);
  const double seconds = watch.seconds();
  Row row;
  row.method = inWords(setup.analysis.scheme);
  row.resolution = stepsText(setup) + ", " + cellsText(model);
  row.dofs = r.dofs;
  row.solve_s = std::min(r.solver.seconds, seconds);
  row.build_s = seconds - row.solve_s;
  row.step_ms = r.steps > 0 ? 1e3 * seconds / r.steps : std::nan("");
  row.converged = r.solver.converged();
  compare(row, retraction::displacementAt(model, r, points), truth);
  return row;
}

}  // namespace

std::vector<Row> timeSchemeRows(const retraction::Model& model, const retraction::Setup& setup,
                                const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options,
                                std::vector<std::string>& skipped, const Progress& progress) {
  std::vector<Row> rows;
  const retraction::Setup best = with(setup, TimeScheme::GeneralisedAlpha, finest);
  if (best.analysis.end_s / (1e-3 * best.analysis.h_ms) > mostSteps) {
    skipped.push_back("time schemes: their reference would take more than " + std::to_string(mostSteps) +
                      " steps; shorten \"end_s\"");
    return rows;
  }
  const Stopwatch budget;
  const retraction::Result truth = retraction::simulate(model, best, {}, progress);
  const std::vector<Eigen::Vector3d> reference = retraction::displacementAt(model, truth, points);
  const std::string words = "generalised alpha, " + stepsText(best) + ", on the same cells";
  const std::vector<double> factors = options.quick ? std::vector<double>{2, 1} : std::vector<double>{4, 2, 1, 0.5};
  for (const TimeScheme scheme : {TimeScheme::ImplicitEuler, TimeScheme::Newmark, TimeScheme::GeneralisedAlpha})
    for (const double factor : factors) {
      const retraction::Setup variant = with(setup, scheme, factor);
      if (budget.seconds() > options.budget_s) {
        skipped.push_back(std::string(inWords(scheme)) + ", " + stepsText(variant) + ": the budget was spent");
        continue;
      }
      rows.push_back(rowOf(model, variant, points, reference, progress));
      rows.back().reference = words;
    }
  return rows;
}

}  // namespace glisson::study
