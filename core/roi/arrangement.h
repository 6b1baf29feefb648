// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "base/diagnostic.h"
#include "roi/contour_stack.h"

namespace glisson::roi {

/// Outlines nearer to each other than this on the average (and more alike than not) are one outline drawn twice, mm.
inline constexpr double repeatedWithin_mm = 0.5;

/// How the outlines of one slice make a region of it.
struct Arrangement {
  static constexpr int repeats = -1;  ///< level of an outline that repeats another one: it does not count
  static constexpr int parity = -2;   ///< level of an outline that flips what it encloses (Combine::Parity)
  /// Of every outline: 0 for those that no other one encloses, 1 for holes in them, 2 for islands in the holes ...
  std::vector<int> level;
  std::size_t repeated = 0;     ///< outlines that repeat another one
  std::size_t overlapping = 0;  ///< outlines that cross another one of their level: both count, as one region
};

/// How a set of points lies to one that is not smaller.
enum class Relation { Apart, Repeated, Enclosed, Crossing };

/// The levels of sets of points, whatever they are (outlines, closed shells). order: all of them, largest first;
/// relation(a, b): how b, which comes later, lies to a. Sets that cross count as one of those that enclose others.
Arrangement arrangeSets(const std::vector<std::size_t>& order,
                        const std::function<Relation(std::size_t a, std::size_t b)>& relation);

/// Outlines as sets of points. Closed rings (2 × n each, mm, one plane) are one region together: those that cross or
/// touch are joined; one that lies inside another (but for at most 1 % of it that sticks out by less than 0.1 mm on the
/// average) is a hole in it; one that repeats another, however it turns, counts once. flips: rings that flip what they
/// enclose instead (even-odd), of which only true repeats (0.05 mm) are dropped. The two lists are of one size.
Arrangement arrange(const std::vector<Eigen::Matrix2Xd>& rings_mm, const std::vector<bool>& flips);

/// Whether a point that lies inside the rings named by in belongs to the region.
bool holds(const Arrangement& arrangement, const std::vector<bool>& in);

/// The stack without outlines that repeat another one of their plane. Exclusions and drafts stay.
ContourStack withoutRepeats(const ContourStack& contours);

/// What is doubtful about the outlines as rasterise() uses them on this grid: repeated, overlapping or cancelling ones,
/// ones off the plane of their slice, ones left out for another one or beyond the grid's slices, ones too small to hold
/// a pixel. drawnHere: the outlines were drawn on this grid, so that those beyond its slices are worth a word.
Diagnostics outlineDoubts(const ContourStack& contours, const image::Grid& grid, bool drawnHere);

}  // namespace glisson::roi
