// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>

#include "roi/contour_stack.h"

namespace glisson::commands {

/// What a reader has said of a slice beside outlines. NoLiver: nothing to outline here. NoWave: outlined or not, its
/// stiffness is not to be measured.
enum class SliceMark { NoLiver, NoWave };

/// What made an outline that nobody drew.
enum class MadeBy { Interpolation, Proposal, Copy };

/// A polygon's vertices as a number (FNV-1a of their bits): the same for the same vertices, however they came there.
inline std::uint64_t digestOf(const roi::Polygon& polygon) {
  std::uint64_t digest = 14695981039346656037ULL;
  for (Eigen::Index v = 0; v < polygon.points_lps_mm.size(); ++v) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, polygon.points_lps_mm.data() + v, sizeof bits);
    for (int byte = 0; byte < 8; ++byte) digest = (digest ^ (bits >> (8 * byte) & 0xFF)) * 1099511628211ULL;
  }
  return digest;
}

/// Everything a reader makes and undo covers: polygons, their name, and marks of slices.
struct Outlines : roi::ContourStack {
  std::map<int, SliceMark> marks;  ///< by slice (k) of the image that is drawn on
  /// Outlines as the program made them, by digestOf: one that is corrected by hand is no longer among them, one whose
  /// correction is undone is again. Accepting changes nothing of it.
  std::map<std::uint64_t, MadeBy> made;

  /// Empty: drawn by hand.
  std::optional<MadeBy> madeBy(const roi::Polygon& polygon) const {
    const auto found = made.find(digestOf(polygon));
    if (found == made.end()) return std::nullopt;
    return found->second;
  }
};

}  // namespace glisson::commands
