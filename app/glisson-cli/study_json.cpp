// SPDX-License-Identifier: GPL-3.0-or-later
#include "study_json.h"

#include <cmath>

namespace glisson::cli {

Json toJson(const std::vector<study::Row>& rows) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  Json all = Json::array();
  for (const study::Row& r : rows)
    all.push_back({{"method", r.method},
                   {"resolution", r.resolution},
                   {"dofs", r.dofs},
                   {"build_s", number(r.build_s)},
                   {"solve_s", number(r.solve_s)},
                   {"step_ms", number(r.step_ms)},
                   {"max_error_mm", number(r.max_error_mm)},
                   {"tip_error_mm", number(r.tip_error_mm)},
                   {"reference", r.reference},
                   {"pareto", r.pareto},
                   {"mean_error_mm", number(r.mean_error_mm)},
                   {"converged", r.converged},
                   {"note", r.note}});
  return all;
}

}  // namespace glisson::cli
