// SPDX-License-Identifier: GPL-3.0-or-later
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

double answersForceAt(const RigidContact& c, double travel_mm) {
  const double borne_N = c.force_N.dot(c.hoist);
  ContactPath path;
  for (const auto& step : c.path) {
    if (step[1] >= borne_N && !path.empty()) {
      const double rise_N = step[1] - path.back()[1], t = (borne_N - path.back()[1]) / rise_N;
      path.push_back({path.back()[0] + t * (step[0] - path.back()[0]), borne_N});
      break;
    }
    path.push_back(step);
  }
  if (path.size() < 2 || path.back()[1] != borne_N || !(path.back()[0] > 0.0)) return forceAt(c.path, travel_mm);
  const double stretch = c.travel_mm / path.back()[0];
  for (auto& step : path) step[0] *= stretch;
  return forceAt(path, travel_mm);
}

std::optional<std::array<double, 2>> passedOnTheWay(const RigidContact& c) {
  constexpr double clearly = 0.9;    // of the largest force: states of the path are loose
  constexpr double before_mm = 1.0;  // the end, where that force was met
  if (!(c.asked_mm > 0.0) || c.path.empty()) return {};
  std::array<double, 2> most = {0.0, 0.0};
  for (const auto& step : c.path)
    if (step[0] < c.path.back()[0] - before_mm && step[1] > most[1]) most = step;
  if (c.path.back()[1] < clearly * most[1]) return most;
  return {};
}

std::optional<std::array<double, 2>> gaveWayOnTheWay(const RigidContact& c) {
  constexpr double clearly = 0.95;  // of the force before: states of the path are loose
  std::optional<std::array<double, 2>> from;
  std::array<double, 2> most = {0.0, 0.0};
  double deepest = clearly, least = 1.0;  // shares of the force that the path fell from
  for (const auto& step : c.path) {
    if (step[1] < most[1]) {
      least = std::min(least, step[1] / most[1]);
      continue;
    }
    if (least < deepest) {
      deepest = least;
      from = most;
    }
    most = step;
    least = 1.0;
  }
  return from;
}

}  // namespace glisson::retraction
