// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace glisson::tools {

/// A sentence for the status line. The text is English, with %1 and %2 where values stand; it is also the key under
/// which whoever shows it finds a translation (context "tools").
struct Sentence {
  const char* text = "";
  std::vector<std::string> values;

  bool empty() const { return *text == '\0'; }
  std::string english() const {
    std::string said = text;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const std::string place = "%" + std::to_string(v + 1);
      if (const std::size_t at = said.find(place); at != std::string::npos) said.replace(at, place.size(), values[v]);
    }
    return said;
  }
};

/// Everything the outline tools say.
namespace say {
inline constexpr const char* closed = "Closed. Drag vertices to adjust, Enter to accept.";
inline constexpr const char* closedCrossing =
    "The outline crosses itself. Move a vertex, or press Enter to accept it all the same.";
inline constexpr const char* accepted = "Accepted.";
inline constexpr const char* acceptCrossing =
    "The outline crosses itself. Press Enter again to accept it all the same.";
inline constexpr const char* crossesNow =
    "The outline crosses itself now and is a draft again. Move a vertex, or press Enter to accept it all the same.";
inline constexpr const char* fewVertices = "A region needs three different vertices, this outline has %1.";
inline constexpr const char* fewVoxels = "A region needs at least %1 voxels, this outline holds %2. Draw it larger.";
inline constexpr const char* fewVerticesLeft =
    "Not changed: a region needs three different vertices, this outline would have %1.";
inline constexpr const char* fewVoxelsLeft =
    "Not changed: a region needs at least %1 voxels, this outline would hold %2.";
inline constexpr const char* asItIs = "%1";  ///< a reason that comes from elsewhere
inline constexpr const char* parked = "Parked as a draft. Backspace takes it up again, Esc discards it.";
inline constexpr const char* parkedOnSlice =
    "Parked as a draft on slice %1. Click it there: Backspace takes it up again, Esc discards it.";
inline constexpr const char* discarded = "Draft discarded; undo brings it back.";
inline constexpr const char* wholeDeleted = "Fewer than three vertices would be left: the whole outline is deleted.";
inline constexpr const char* becomesHole = "An outline inside a region becomes a hole.";
inline constexpr const char* replacesInterpolated =
    "Once accepted, this outline replaces the interpolated ones of the slice.";
inline constexpr const char* nothingToSculpt = "There is no outline on this slice to sculpt.";
inline constexpr const char* selectFirst = "Select an outline first: click its edge.";
inline constexpr const char* cutInTwo = "Cut in two.";
inline constexpr const char* splitNeeds = "Split needs an edge (two neighbours) or two vertices apart.";
inline constexpr const char* trimNeeds = "Trim needs more vertices: at least three stay.";
inline constexpr const char* leftOut = "This outline is left out of the region.";
inline constexpr const char* counts = "This outline counts.";
inline constexpr const char* painted = "Painted. Paint on, or press Enter to accept.";
inline constexpr const char* nothingToErase = "There is no outline under the eraser.";
inline constexpr const char* erased = "The whole outline is erased; undo brings it back.";
inline constexpr const char* smallParts = "Parts and holes of fewer than %1 voxels were left out: %2.";
inline constexpr const char* meetsNone = "The selected outline meets no other one of its kind on this slice.";
inline constexpr const char* combinedAlready = "Nothing to do: the outlines mean that already.";
inline constexpr const char* nothingLeft = "Not changed: no outline would be left.";
inline constexpr const char* united = "The outlines are one region now.";
inline constexpr const char* takenOut = "The selected outline is taken out of those it met.";
inline constexpr const char* shared = "What the outlines had in common is left.";
}  // namespace say

}  // namespace glisson::tools
