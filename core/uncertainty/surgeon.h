// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/language.h"
#include "uncertainty/sampling.h"

namespace glisson::uncertainty {

/// Radius of the ball about its mean that holds 95 % of a normal vector, of its covariance (mm²): from 1.96 standard
/// deviations along a line to 2.80 in all directions. By a fixed sample, to 2 %.
double radius95_mm(const Eigen::Matrix3d& covariance_mm2);

/// The end of a vessel that is told: with a comparison the one that both predictions set furthest apart, else the one
/// whose place is least sure.
struct VesselTip {
  std::size_t landmark = 0;
  double moves_mm = 0.0;           ///< by the retraction, measured stiffness
  double place95_mm = 0.0;         ///< it lies within this of its place, with 95 %
  std::optional<double> apart_mm;  ///< from where the textbook stiffness puts it; with a comparison, as what follows
  std::optional<Interval> apart95_mm;
  std::optional<double> beyond;  ///< probability that it is 5 mm or more
};

/// tips: landmarks, by their numbers. Nothing where none of them lies in the body.
std::optional<VesselTip> tipOf(const FirstOrder& first, const Spread& spread, const std::vector<std::size_t>& tips);

/// One sentence for who operates: where the end of a vessel will lie, how sure that is, and how likely it is 5 mm or
/// more from where the textbook puts it. Without a vessel the same of what the retractor holds; empty where there is
/// neither a vessel nor a comparison.
std::string forSurgeon(const std::optional<VesselTip>& tip, const Spread& spread, Language language);

/// A source on the axis of a chart, in a few words.
std::string labelOf(SourceKind kind, Language language);

/// "7.3 mm", "< 0.1 mm"; "88 %", "less than 1 %": as exact as an estimate is.
std::string millimetres(double mm, Language language);
std::string percent(double probability, Language language);
/// "4.1 to 10 mm".
std::string rangeOf(const Interval& interval, Language language);

}  // namespace glisson::uncertainty
