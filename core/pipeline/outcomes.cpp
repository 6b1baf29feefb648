// What of a run's ends is told: bars that slip, fold, cut or were moved, and solves that did not converge.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "pipeline/detail/outcomes.h"

namespace glisson::pipeline::detail {
namespace {

using retraction::BarOutcome;
using retraction::RigidContact;

constexpr double pastLimit = 0.98;  ///< of the largest force: a bar by travel that bears less is behind a limit

std::string wordsOf(const RigidContact& c) {
  std::ostringstream t;
  t.precision(3);
  if (c.asked_N > 0.0)
    t << c.asked_N << " N";
  else
    t << "a travel of " << c.asked_mm << " mm";
  return t.str();
}

/// Travel at the largest force of the way, mm.
double travelAtCapacity(const RigidContact& c) {
  const auto largest = std::max_element(c.path.begin(), c.path.end(),
                                        [](const auto& a, const auto& b) { return a[1] < b[1]; });
  return largest == c.path.end() ? c.travel_mm : (*largest)[0];
}

void tellOfBar(const retraction::Result& result, const std::string& stiffness, Diagnostics& d) {
  const RigidContact& c = *result.contact;
  const auto failed = [&](DiagnosticCode code) {
    d.add(code, {{"capacity_N", c.capacity_N},
                 {"travel_mm", code == DiagnosticCode::RetractorSlips ? travelAtCapacity(c) : c.travel_mm},
                 {"stiffness", stiffness},
                 {"asked", wordsOf(c)},
                 {"asked_N", c.asked_N},
                 {"asked_mm", c.asked_mm}});
  };
  switch (c.outcome) {
    case BarOutcome::Slips:
      return failed(DiagnosticCode::RetractorSlips);
    case BarOutcome::Folds:
      return failed(DiagnosticCode::RetractorFolds);
    case BarOutcome::Cuts:
      return failed(DiagnosticCode::RetractorCuts);
    case BarOutcome::Reached:
      if (const double along_N = c.force_N.dot(c.hoist); c.asked_mm > 0.0 && along_N < pastLimit * c.capacity_N)
        d.add(DiagnosticCode::RetractorPastLimit,
              {{"force_N", along_N}, {"capacity_N", c.capacity_N}, {"stiffness", stiffness}});
      return;
    case BarOutcome::LoadsNotBorne:
    case BarOutcome::Stopped:
      return;
  }
}

void tellOfSolve(const retraction::Result& result, const std::string& stiffness, Diagnostics& d) {
  const bool told = result.contact && (result.contact->outcome == BarOutcome::Slips ||
                                       result.contact->outcome == BarOutcome::Folds ||
                                       result.contact->outcome == BarOutcome::Cuts);
  if (result.solver.converged() || told) return;
  const bool loads = result.contact && result.contact->outcome == BarOutcome::LoadsNotBorne;
  d.add(loads ? DiagnosticCode::LoadsNotBorne : DiagnosticCode::NotConverged,
        {{"stiffness", stiffness}, {"residual", result.solver.residual}, {"tolerance", result.solver.tolerance}});
}

}  // namespace

void tellOfOutcomes(RunResult& r) {
  for (const bool atlas : {false, true}) {
    const retraction::Result* result = atlas ? (r.atlas ? &*r.atlas : nullptr) : &r.primary;
    if (result == nullptr) continue;
    const std::string stiffness = atlas ? "atlas" : "own";
    if (result->contact) tellOfBar(*result, stiffness, r.diagnostics);
    tellOfSolve(*result, stiffness, r.diagnostics);
  }
  if (!r.primary.contact) return;
  const RigidContact& c = *r.primary.contact;
  if (std::abs(c.moved_mm) > c.barRadius_mm)
    r.diagnostics.add(DiagnosticCode::RetractorLaid, {{"distance_mm", std::abs(c.moved_mm)},
                                                      {"side", std::string(c.moved_mm < 0 ? "before" : "beyond")}});
}

}  // namespace glisson::pipeline::detail
