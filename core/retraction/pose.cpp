// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/pose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

#include "anatomy/regions.h"
#include "base/error.h"
#include "retraction/body.h"
#include "retraction/hoist_view.h"

namespace glisson::retraction {
namespace {

constexpr double step_mm = 5.0;
constexpr double usualVolume_mm3 = 1.55e6, usualHeight_mm = 180.0;  // of the livers that the rule was found on
constexpr double largestTurn = std::numbers::pi / 6.0;

/// Depth along the hoist of the bar's middle at first touch; nothing where the bar passes the surface by.
std::optional<double> firstTouch(const mechanics::TriangleSurface& surface, const HoistFrame& frame,
                                 const Eigen::Vector3d& through_mm, const Eigen::Vector3d& axis,
                                 const Retractor& retractor) {
  const double r = 0.5 * retractor.diameter_mm, half = std::max(0.0, 0.5 * retractor.length_mm - r);
  const Eigen::Vector3d across = frame.hoist.cross(axis);
  double first = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& v : surface.vertices) {
    const Eigen::Vector3d d = v - through_mm;
    const double beyond = std::max(0.0, std::abs(d.dot(axis)) - half), b = d.dot(across);
    const double square = r * r - beyond * beyond - b * b;
    if (square >= 0.0) first = std::min(first, v.dot(frame.hoist) - std::sqrt(square));
  }
  return std::isfinite(first) ? std::optional(first) : std::nullopt;
}

std::optional<Pose> touching(const mechanics::TriangleSurface& surface, const HoistView& view,
                             const Retractor& retractor, const Eigen::Vector2d& at, double angle) {
  const HoistFrame& f = view.frame();
  Pose pose;
  pose.hoist = f.hoist;
  pose.axis = std::cos(angle) * f.aside + std::sin(angle) * f.up;
  const Eigen::Vector3d through = at.x() * f.aside + at.y() * f.up;
  const auto depth = firstTouch(surface, f, through, pose.axis, retractor);
  if (!depth) return std::nullopt;
  pose.centre_mm = through + *depth * f.hoist;
  const BarView seen = view.bar(at, angle, retractor.length_mm, retractor.diameter_mm);
  pose.covered_mm = seen.covered_mm;
  pose.thickness_mm = seen.thickness_mm;
  pose.slope = seen.slope;
  return pose;
}

/// Angle, from aside towards up, of the scene's axis seen along the hoist.
std::optional<double> angleOf(const Retractor& retractor, const HoistFrame& frame) {
  if (!retractor.axis) return std::nullopt;
  return std::atan2(retractor.axis->dot(frame.up), retractor.axis->dot(frame.aside));
}

/// A place of the search: what the bar sees there, and how far that is from what is wanted (1: as wanted).
struct Place {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double angle = 0.0;
  BarView seen;
  double quality = 0.0;
};

double qualityOf(const BarView& seen, const PoseRule& rule) {
  return std::min({1.0, seen.covered_mm / rule.covered_mm, seen.thickness_mm / rule.thickness_mm,
                   rule.slope / std::max(rule.slope, std::abs(seen.slope))});
}

/// First place from the right at which half of the bar's end is before the liver.
std::optional<double> lateralMargin(const HoistView& view, double up_mm, double diameter_mm) {
  for (double x = view.low_mm().x() + 0.5; x < view.high_mm().x(); x += 1.0)
    if (view.bar({x, up_mm}, 0.0, 1.0, diameter_mm).covered_mm > 0.0) return x;
  return std::nullopt;
}

/// The best place at one height: of those as wanted the most level one near where the bar's lateral end lies at the
/// margin; else the one nearest to what is wanted.
std::optional<Place> bestAt(const HoistView& view, const PoseRule& rule, const Retractor& retractor, double up_mm,
                            double angle) {
  const auto margin = lateralMargin(view, up_mm, retractor.diameter_mm);
  if (!margin) return std::nullopt;
  const double start = *margin + 0.5 * retractor.length_mm;
  std::optional<Place> best;
  double least = std::numeric_limits<double>::infinity();
  for (double x = *margin; x <= std::min(start + 0.75 * retractor.length_mm, view.high_mm().x()); x += 1.0) {
    Place place{{x, up_mm}, angle, view.bar({x, up_mm}, angle, retractor.length_mm, retractor.diameter_mm), 0.0};
    place.quality = qualityOf(place.seen, rule);
    const double cost = std::abs(place.seen.slope) / rule.slope + std::abs(x - start) / (0.5 * retractor.length_mm);
    const bool better = !best || place.quality > best->quality || (place.quality == best->quality && cost < least);
    if (!better) continue;
    best = place;
    least = cost;
  }
  return best;
}

[[noreturn]] void noPlace(const PoseRule& rule, const std::optional<Place>& best, double inferiorUp_mm) {
  std::ostringstream text;
  text.precision(2);
  auto mm = [](double v) { return std::to_string(static_cast<int>(std::lround(v))); };
  text << "no place for the retractor: nowhere from " << mm(rule.lowest_mm) << " to " << mm(rule.highest_mm)
       << " mm above the lowest point of the right lobe is its surface level over " << mm(rule.covered_mm)
       << " mm of the bar, with " << mm(rule.thickness_mm) << " mm of liver before it";
  if (best)
    text << "; the best place, " << mm(best->at.y() - inferiorUp_mm) << " mm above, covers "
         << mm(best->seen.covered_mm) << " mm, with " << mm(best->seen.thickness_mm) << " mm of liver and a slope of "
         << std::abs(best->seen.slope);
  text << ". Give the point yourself (\"at\"), or a shorter bar (\"length_mm\")";
  throw BadInput(text.str());
}

}  // namespace

PoseRule poseRule(const SmoothBody& body, const Retractor& retractor) {
  const image::Mask mask = body.mask();
  PoseRule rule;
  rule.inferior_mm = anatomy::inferiorRightLobePoint(mask);
  rule.covered_mm = 0.75 * retractor.length_mm;
  // What a bar bears goes with the thickness before it, what it is to bear with the volume.
  rule.thickness_mm = 75.0 * std::clamp(body.volume_mm3() / usualVolume_mm3, 0.5, 1.0);
  // Height of the right lobe: of the right third, as for its lowest point.
  const HoistFrame frame(retractor.direction);
  double right = std::numeric_limits<double>::infinity(), left = -right, top = -right;
  auto forPoints = [&](auto&& visit) {
    for (int k = 0; k < mask.grid.size.z(); ++k)
      for (int j = 0; j < mask.grid.size.y(); ++j)
        for (int i = 0; i < mask.grid.size.x(); ++i)
          if (mask.at(i, j, k) != 0) visit(mask.grid.indexToLps(Eigen::Vector3d(i, j, k)));
  };
  forPoints([&](const Eigen::Vector3d& p) {
    right = std::min(right, p.x());
    left = std::max(left, p.x());
  });
  forPoints([&](const Eigen::Vector3d& p) {
    if (p.x() <= right + (left - right) / 3.0) top = std::max(top, p.dot(frame.up));
  });
  const double height = top - rule.inferior_mm.dot(frame.up);
  rule.lowest_mm = 70.0 * std::min(1.0, height / usualHeight_mm);
  rule.highest_mm = height - 0.35 * std::min(height, usualHeight_mm);
  return rule;
}

std::vector<Pose> poseCandidates(const SmoothBody& body, const mechanics::TriangleSurface& surface,
                                 const Retractor& retractor) {
  const HoistView view(surface, HoistFrame(retractor.direction));
  const PoseRule rule = poseRule(body, retractor);
  const double inferiorUp_mm = rule.inferior_mm.dot(view.frame().up);

  std::vector<Place> places;
  auto search = [&](double angle) {
    for (double h = rule.lowest_mm; h <= rule.highest_mm + 1e-9; h += step_mm)
      if (const auto place = bestAt(view, rule, retractor, inferiorUp_mm + h, angle)) places.push_back(*place);
  };
  const auto asWanted = [](const Place& p) { return p.quality >= 1.0; };
  const auto given = angleOf(retractor, view.frame());
  search(given.value_or(0.0));
  if (!given && std::none_of(places.begin(), places.end(), asWanted))
    for (const double share : {0.5, -0.5, 1.0, -1.0}) search(share * largestTurn);
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (a.quality != b.quality) return a.quality > b.quality;
    return a.at.y() != b.at.y() ? a.at.y() < b.at.y() : std::abs(a.seen.slope) < std::abs(b.seen.slope);
  });

  std::vector<Pose> poses;
  for (const Place& place : places) {
    if (place.quality < 1.0 / 3.0 || place.seen.covered_mm < 0.5 * rule.covered_mm ||
        place.seen.thickness_mm < 0.5 * rule.thickness_mm)
      continue;
    auto pose = touching(surface, view, retractor, place.at, place.angle);
    if (!pose) continue;
    pose->height_mm = place.at.y() - inferiorUp_mm;
    pose->wanted = asWanted(place);
    poses.push_back(*pose);
  }
  if (poses.empty()) noPlace(rule, places.empty() ? std::nullopt : std::optional(places.front()), inferiorUp_mm);
  return poses;
}

Pose poseAt(const mechanics::TriangleSurface& surface, const Retractor& retractor, const Eigen::Vector3d& at_mm) {
  const HoistView view(surface, HoistFrame(retractor.direction));
  const HoistFrame& f = view.frame();
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d a = surface.vertices[static_cast<std::size_t>(t[0])],
                          b = surface.vertices[static_cast<std::size_t>(t[1])],
                          c = surface.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.dot(f.hoist) < -0.3 * normal.norm()) nearest = std::min(nearest, ((a + b + c) / 3.0 - at_mm).norm());
  }
  const Eigen::Vector2d at(at_mm.dot(f.aside), at_mm.dot(f.up));
  double angle = angleOf(retractor, f).value_or(0.0);
  if (!retractor.axis) {
    const BarView seen = view.bar(at, 0.0, retractor.length_mm, retractor.diameter_mm);
    if (std::abs(seen.slope) > PoseRule{}.slope && std::abs(seen.tilt) > 0.0)
      angle = std::clamp(-std::atan(seen.slope / seen.tilt), -largestTurn, largestTurn);
  }
  auto pose = touching(surface, view, retractor, at, angle);
  if (!pose || nearest > retractor.diameter_mm + 5.0) refuseContact(at_mm, nearest);
  pose->height_mm = at.y() - view.low_mm().y();
  return *pose;
}

}  // namespace glisson::retraction
