#include "retraction/contact_path.h"

#include <algorithm>

#include "retraction/simulate.h"

namespace glisson::retraction {

double forceAt(const ContactPath& path, double travel_mm) {
  if (path.empty()) return 0.0;
  if (travel_mm <= path.front()[0]) return path.front()[1];
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i][0] >= travel_mm && path[i][0] > path[i - 1][0]) {
      const double t = (travel_mm - path[i - 1][0]) / (path[i][0] - path[i - 1][0]);
      return path[i - 1][1] + t * (path[i][1] - path[i - 1][1]);
    }
  return path.back()[1];
}

double travelAtCapacity(const RigidContact& c) {
  for (std::size_t i = 0; i < c.path.size(); ++i) {
    if (c.path[i][1] < c.capacity_N) continue;
    if (i == 0) return c.path[0][0];
    const double rise_N = c.path[i][1] - c.path[i - 1][1];
    const double t = (c.capacity_N - c.path[i - 1][1]) / rise_N;
    return c.path[i - 1][0] + std::clamp(t, 0.0, 1.0) * (c.path[i][0] - c.path[i - 1][0]);
  }
  // The answer's cells bore more than the path's.
  const auto most =
      std::max_element(c.path.begin(), c.path.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  return most == c.path.end() ? c.travel_mm : (*most)[0];
}

std::optional<double> passedOnTheWay_N(const RigidContact& c) {
  constexpr double clearly = 0.9;    // of the largest force: states of the path are loose
  constexpr double before_mm = 1.0;  // the end, where that force was met
  if (!(c.asked_mm > 0.0) || c.path.empty()) return {};
  double most_N = 0.0;
  for (const auto& [travel_mm, force_N] : c.path)
    if (travel_mm < c.path.back()[0] - before_mm) most_N = std::max(most_N, force_N);
  if (c.path.back()[1] < clearly * most_N) return most_N;
  return {};
}

}  // namespace glisson::retraction
