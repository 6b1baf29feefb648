// SPDX-License-Identifier: GPL-3.0-or-later
#include "study_json.h"

namespace glisson::cli {

Json toJson(const std::vector<study::Row>& rows) {
  Json all = Json::array();
  for (const study::Row& r : rows)
    all.push_back({{"method", r.method},
                   {"resolution", r.resolution},
                   {"dofs", r.dofs},
                   {"build_s", orNull(r.build_s)},
                   {"solve_s", orNull(r.solve_s)},
                   {"step_ms", orNull(r.step_ms)},
                   {"max_error_mm", orNull(r.max_error_mm)},
                   {"tip_error_mm", orNull(r.tip_error_mm)},
                   {"reference", r.reference},
                   {"pareto", r.pareto},
                   {"mean_error_mm", orNull(r.mean_error_mm)},
                   {"converged", r.converged},
                   {"note", r.note}});
  return all;
}

}  // namespace glisson::cli
