// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/sha256.h"
#include "roi/contour_io.h"
#include "session/session.h"

namespace glisson::test {

/// Everything that a reader has made, to the last bit: outlines, marks, and what is being drawn, as the draft that it
/// comes back as.
inline std::string digestOf(session::Session& session, const std::string& sopInstanceUid) {
  roi::ContourStack all = session.contours();
  if (session.tool().drawing().cols() > 0) {
    roi::Polygon inWork;
    inWork.state = roi::PolygonState::Draft;
    inWork.points_lps_mm = session.tool().outlineInWork();
    inWork.sopInstanceUid = sopInstanceUid;
    all.polygons.push_back(inWork);
  }
  std::string text = roi::toJson(all);
  for (const auto& [slice, mark] : session.contours().marks)
    text += std::to_string(slice) + (mark == commands::SliceMark::NoLiver ? "l" : "w");
  return sha256(text.data(), text.size());
}

}  // namespace glisson::test
