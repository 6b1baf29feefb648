// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/markups.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/frames.h"

namespace glisson::exchange {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";

}  // namespace

std::string contoursToMarkups(const roi::ContourStack& contours) {
  Json markups = Json::array();
  int curve = 0;
  for (const roi::Polygon& p : contours.polygons) {
    if (p.state == roi::PolygonState::Draft) continue;
    Json points = Json::array();
    for (Eigen::Index n = 0; n < p.points_lps_mm.cols(); ++n) {
      const Eigen::Vector3d v = p.points_lps_mm.col(n);
      points.push_back({{"id", std::to_string(n + 1)},
                        {"label", ""},
                        {"position", {v.x(), v.y(), v.z()}},
                        {"selected", true},
                        {"locked", false},
                        {"visibility", true},
                        {"positionStatus", "defined"}});
    }
    ++curve;
    markups.push_back({{"type", "ClosedCurve"},
                       {"name", (p.exclude ? "exclude " : "contour ") + std::to_string(curve)},
                       {"coordinateSystem", "LPS"},
                       {"coordinateUnits", "mm"},
                       {"locked", true},
                       {"controlPoints", points}});
  }
  const Json j = {{"@schema", schema}, {"markups", markups}};
  return j.dump(1) + "\n";
}

roi::ContourStack markupsToContours(const std::string& text, const std::string& source) {
  roi::ContourStack contours;
  try {
    const Json j = Json::parse(text);
    for (const Json& m : j.at("markups")) {
      if (m.at("type") != "ClosedCurve") continue;
      const std::string frame = m.value("coordinateSystem", "LPS");
      if (frame != "LPS" && frame != "RAS")
        throw BadInput("'" + source + "' has a curve in the unknown coordinate system '" + frame.substr(0, 8) + "'");
      roi::Polygon p;
      const Json& points = m.at("controlPoints");
      p.points_lps_mm.resize(3, static_cast<Eigen::Index>(points.size()));
      for (std::size_t n = 0; n < points.size(); ++n) {
        const auto v = points[n].at("position").get<std::array<double, 3>>();
        const Eigen::Vector3d point(v[0], v[1], v[2]);
        p.points_lps_mm.col(static_cast<Eigen::Index>(n)) = frame == "RAS" ? rasToLps(point) : point;
      }
      p.exclude = m.value("name", "").starts_with("exclude");
      if (p.points_lps_mm.cols() >= 3) contours.polygons.push_back(std::move(p));
    }
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'" + source + "' is no Slicer markups file");
  }
  if (contours.polygons.empty()) throw BadInput("'" + source + "' holds no closed curve of three points");
  return contours;
}

}  // namespace glisson::exchange
