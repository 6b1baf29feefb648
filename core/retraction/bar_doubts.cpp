// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/detail/bar_doubts.h"

#include <array>
#include <optional>
#include <sstream>

#include "retraction/contact_path.h"

namespace glisson::retraction::detail {
namespace {

std::string askedOf(const RigidContact& c) {
  std::ostringstream t;
  t.precision(3);
  if (c.asked_N > 0.0)
    t << c.asked_N << " N";
  else
    t << "a travel of " << c.asked_mm << " mm";
  return t.str();
}

}  // namespace

void tellLoadsNotBorne(const std::string& stiffness, Result& r) {
  r.doubt(DiagnosticCode::LoadsNotBorne,
          {{"stiffness", stiffness}, {"residual", r.solver.residual}, {"tolerance", r.solver.tolerance}});
}

bool doubtOfBar(const RigidContact& c, const std::string& stiffness, Result& r) {
  const auto failed = [&](DiagnosticCode code) {
    r.doubt(code, {{"capacity_N", c.capacity_N},
                   {"capacity_travel_mm", c.capacityAt_mm},
                   {"travel_mm", c.travel_mm},
                   {"stiffness", stiffness},
                   {"asked", askedOf(c)},
                   {"asked_N", c.asked_N},
                   {"asked_mm", c.asked_mm}});
    return true;
  };
  switch (c.outcome) {
    case mechanics::ContactOutcome::Slips: return failed(DiagnosticCode::RetractorSlips);
    case mechanics::ContactOutcome::Folds: return failed(DiagnosticCode::RetractorFolds);
    case mechanics::ContactOutcome::Cuts: return failed(DiagnosticCode::RetractorCuts);
    case mechanics::ContactOutcome::LoadsNotBorne: tellLoadsNotBorne(stiffness, r); return true;
    case mechanics::ContactOutcome::Reached:
      if (const std::optional<std::array<double, 2>> most = passedOnTheWay(c)) {
        r.doubt(DiagnosticCode::RetractorPastLimit,
                {{"force_N", c.force_N.dot(c.hoist)}, {"capacity_N", (*most)[1]}, {"stiffness", stiffness}});
        return true;
      }
      if (const std::optional<std::array<double, 2>> from = gaveWayOnTheWay(c))
        r.doubt(DiagnosticCode::RetractorJumps, {{"capacity_N", (*from)[1]},
                                                 {"capacity_travel_mm", (*from)[0]},
                                                 {"force_N", c.force_N.dot(c.hoist)},
                                                 {"travel_mm", c.travel_mm},
                                                 {"stiffness", stiffness}});
      return false;
    case mechanics::ContactOutcome::Stopped: return false;
  }
  return false;
}

}  // namespace glisson::retraction::detail
