// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/sources.h"

#include <sstream>

namespace glisson::uncertainty {
namespace {

std::string text(const char* before, double value, const char* after) {
  std::ostringstream t;
  t.precision(3);
  t << before << value << after;
  return t.str();
}

}  // namespace

SourceWords wordsOf(SourceKind kind, const Spreads& s, double noise) {
  constexpr const char* own = "own estimate";
  switch (kind) {
    case SourceKind::ElastogramNoise:
      return {"elastogram-noise",
              text("", 100 * noise, " % of a voxel, ") +
                  text("correlated over ", s.correlation_mm, " mm; more where the map was filled in"),
              s.noise < 0 ? "from the map" : "given"};
    case SourceKind::ElastogramRepeatability:
      return {"elastogram-repeatability", text("", 100 * s.repeatability, " % of the whole elastogram"), "qiba2022mre"};
    case SourceKind::Outline:
      return {"outline", text("", s.outline_mm, " mm of the whole outline"), "heimann2009comparison"};
    case SourceKind::Poisson: return {"poisson", text("", s.poisson, " of Poisson's ratio"), own};
    case SourceKind::Supports:
      return {"supports", text("", 100 * s.supports, " % of the stiffness of bed, springs and ligaments"), own};
    case SourceKind::Capsule:
      return {"capsule", text("", 100 * s.capsule, " % of the capsule's tension"), "umale2011characterization"};
    case SourceKind::Force: return {"force", text("", 100 * s.force, " % of the force on the bar"), own};
    case SourceKind::Density: return {"density", text("", 100 * s.density, " % of the liver's density"), own};
    case SourceKind::BarPlace: return {"bar-place", text("", s.barPlace_mm, " mm along and across the bar"), own};
    case SourceKind::BarDirection:
      return {"bar-direction", text("", s.barTurn_deg, " degrees about each of three axes"), own};
    case SourceKind::Cells:
      return {"cells", "the error estimated from cells of twice the edge", "discretisation_error"};
    case SourceKind::Kinematics:
      return {"kinematics", "what linear theory misses, by one corotational correction", "linear_gap_mm"};
    case SourceKind::Solver:
      return {"solver", "what the solver left over, taken as one standard deviation", "solver.residual"};
    case SourceKind::BeyondFirstOrder:
      return {"beyond-first-order", "what the first order missed of full solves", "checks"};
  }
  return {};
}

}  // namespace glisson::uncertainty
