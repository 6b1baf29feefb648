// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/compared.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace glisson::study {

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
  row.tip_error_mm = std::numeric_limits<double>::quiet_NaN();
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
  row.max_error_mm = n > 0 ? largest : std::numeric_limits<double>::quiet_NaN();
  row.mean_error_mm = n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::quiet_NaN();
  if (n < u.size())
    row.note += (row.note.empty() ? "" : "; ") + std::to_string(u.size() - n) + " of " + std::to_string(u.size()) +
                " points lie outside this body";
}

}  // namespace glisson::study
