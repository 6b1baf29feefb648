// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/contour_io.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"

namespace glisson::roi {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* schema = "glisson/contours/1";
constexpr std::uintmax_t largestFile = 256u << 20;  // bytes

const char* name(PolygonState state) {
  switch (state) {
    case PolygonState::Draft: return "draft";
    case PolygonState::Accepted: return "accepted";
    case PolygonState::Interpolated: return "interpolated";
  }
  return "accepted";
}

/// Looks up keys of one object and complains by name.
class Reader {
 public:
  Reader(const Json& object, std::string where, std::initializer_list<const char*> known)
      : object_(object), where_(std::move(where)) {
    if (!object.is_object()) throw BadInput(where_ + " must be a JSON object, not " + object.type_name());
    for (const auto& [key, value] : object.items())
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        std::string list;
        for (const char* k : known) list += std::string(list.empty() ? "" : ", ") + k;
        throw BadInput(where_ + " has the unknown key '" + key.substr(0, 64) + "'; known keys: " + list);
      }
  }

  const Json& need(const char* key) const {
    if (!object_.contains(key)) throw BadInput(where_ + " has no key '" + key + "'; it is required");
    return object_.at(key);
  }

  std::string text(const char* key, const std::string& otherwise) const {
    if (!object_.contains(key)) return otherwise;
    const Json& value = object_.at(key);
    if (!value.is_string()) throw BadInput(place(key) + " must be a text, not " + value.type_name());
    return value.get<std::string>();
  }

  bool flag(const char* key, bool otherwise) const {
    if (!object_.contains(key)) return otherwise;
    const Json& value = object_.at(key);
    if (!value.is_boolean()) throw BadInput(place(key) + " must be true or false, not " + value.type_name());
    return value.get<bool>();
  }

  std::string place(const char* key) const { return where_ + ", key '" + key + "',"; }

 private:
  const Json& object_;
  std::string where_;
};

Eigen::Matrix3Xd readPoints(const Json& value, const std::string& where) {
  if (!value.is_array()) throw BadInput(where + " must be a list of [x, y, z] in LPS mm, not " + value.type_name());
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(value.size()));
  for (std::size_t v = 0; v < value.size(); ++v) {
    const Json& p = value[v];
    const bool good = p.is_array() && p.size() == 3 && p[0].is_number() && p[1].is_number() && p[2].is_number();
    if (!good) throw BadInput(where + " vertex " + std::to_string(v) + " must be three numbers [x, y, z] in LPS mm");
    for (std::size_t a = 0; a < 3; ++a)
      points(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(v)) = p[a].get<double>();
  }
  return points;
}

PolygonState readState(const std::string& text, const std::string& where) {
  for (const auto state : {PolygonState::Draft, PolygonState::Accepted, PolygonState::Interpolated})
    if (text == name(state)) return state;
  throw BadInput(where + " is '" + text.substr(0, 64) + "'; it must be draft, accepted or interpolated");
}

Combine readCombine(const std::string& text, const std::string& where) {
  if (text == "union") return Combine::Union;
  if (text == "parity") return Combine::Parity;
  throw BadInput(where + " is '" + text.substr(0, 64) + "'; it must be union or parity");
}

/// Parses, refusing repeated keys (JSON would silently keep the last).
Json parse(const std::string& text, const std::string& source) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int, nlohmann::detail::parse_event_t event, Json& value) {
    using Event = nlohmann::detail::parse_event_t;
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end && !keys.empty()) keys.pop_back();
    if (event == Event::key && !keys.empty() && !keys.back().insert(value.get<std::string>()).second)
      throw BadInput(source + " has the key '" + value.get<std::string>().substr(0, 64) +
                     "' twice in one object; leave one of them");
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw BadInput(source + " is not valid JSON at line " + std::to_string(line));
  } catch (const nlohmann::json::exception&) {
    throw BadInput(source + " is not valid JSON (a number too large for a double)");
  }
}

}  // namespace

std::string toJson(const ContourStack& contours) {
  Json polygons = Json::array();
  for (const Polygon& polygon : contours.polygons) {
    if (!polygon.points_lps_mm.allFinite())
      throw BadArgument("a polygon with a coordinate that is not finite cannot be written as JSON");
    Json points = Json::array();
    for (Eigen::Index v = 0; v < polygon.points_lps_mm.cols(); ++v)
      points.push_back({polygon.points_lps_mm(0, v), polygon.points_lps_mm(1, v), polygon.points_lps_mm(2, v)});
    Json one = {
        {"state", name(polygon.state)}, {"exclude", polygon.exclude}, {"sop_instance_uid", polygon.sopInstanceUid}};
    if (polygon.combine == Combine::Parity) one["combine"] = "parity";
    one["points_lps_mm"] = std::move(points);
    polygons.push_back(std::move(one));
  }
  const Json all = {{"schema", schema},
                    {"name", contours.name},
                    {"frame_of_reference_uid", contours.frameOfReferenceUid},
                    {"series_uid", contours.seriesUid},
                    {"polygons", std::move(polygons)}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ContourStack contoursFromJson(const std::string& text, const std::string& source) {
  const Json all = parse(text, source);
  const Reader top(all, source, {"schema", "name", "frame_of_reference_uid", "series_uid", "polygons"});
  top.need("schema");
  if (top.text("schema", "") != schema)
    throw BadInput(source + ", key 'schema', is '" + top.text("schema", "").substr(0, 64) + "'; expected '" + schema +
                   "'");
  ContourStack result;
  result.name = top.text("name", result.name);
  result.frameOfReferenceUid = top.text("frame_of_reference_uid", "");
  result.seriesUid = top.text("series_uid", "");
  const Json& polygons = top.need("polygons");
  if (!polygons.is_array()) throw BadInput(top.place("polygons") + " must be a list, not " + polygons.type_name());
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const std::string where = source + ", polygons[" + std::to_string(p) + "]";
    const Reader reader(polygons[p], where, {"state", "exclude", "combine", "sop_instance_uid", "points_lps_mm"});
    Polygon polygon;
    polygon.points_lps_mm = readPoints(reader.need("points_lps_mm"), reader.place("points_lps_mm"));
    polygon.exclude = reader.flag("exclude", false);
    polygon.state = readState(reader.text("state", "accepted"), reader.place("state"));
    polygon.combine = readCombine(reader.text("combine", "union"), reader.place("combine"));
    polygon.sopInstanceUid = reader.text("sop_instance_uid", "");
    if (polygon.state != PolygonState::Draft && polygon.points_lps_mm.cols() < 3)
      throw BadInput(reader.place("points_lps_mm") + " has " + std::to_string(polygon.points_lps_mm.cols()) +
                     " vertices; a polygon that counts needs at least 3");
    result.polygons.push_back(std::move(polygon));
  }
  return result;
}

ContourStack readContours(const std::filesystem::path& file) {
  const std::string source = "'" + file.filename().string() + "'";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw BadInput("the contour file " + source + " is not there, or is no regular file");
  const auto bytes = std::filesystem::file_size(file, error);
  if (error || bytes > largestFile)
    throw BadInput("the contour file " + source + " is larger than 256 MiB; this is no contour file");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw BadInput("the contour file " + source + " cannot be read");
  return contoursFromJson(text.str(), source);
}

void writeContours(const std::filesystem::path& file, const ContourStack& contours) {
  writeAtomically(file, toJson(contours));
}

}  // namespace glisson::roi
