// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/run_figures.h"

#include <QTime>
#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "session/kept_results.h"
#include "session/session.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Place {
  const char* words;
  const char* unit;
  int decimals;
  double factor;
  std::vector<const char*> keys;
};

const std::vector<Place>& places() {
  static const std::vector<Place> all = {
      {QT_TRANSLATE_NOOP("figures", "Mean stiffness of the liver"), "kPa", 2, 1.0, {"stiffness", "mean_kPa"}},
      {QT_TRANSLATE_NOOP("figures", "SD of the stiffness"), "kPa", 2, 1.0, {"stiffness", "sd_kPa"}},
      {QT_TRANSLATE_NOOP("figures", "Volume"), "mL", 0, 1.0, {"model", "volume_mL"}},
      {QT_TRANSLATE_NOOP("figures", "Difference at the retractor"), "mm", 2, 1.0, {"difference", "at_retractor_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Its error by the cells"),
       "mm",
       2,
       1.0,
       {"discretisation_error", "difference", "at_retractor_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Mean difference"), "mm", 2, 1.0, {"difference", "mean_mm"}},
      {QT_TRANSLATE_NOOP("figures", "95 % of the liver within"), "mm", 2, 1.0, {"difference", "p95_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Largest difference"), "mm", 2, 1.0, {"difference", "max_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Mean difference of vessels"), "mm", 2, 1.0, {"difference", "vessels", "mean_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Vessels 5 mm apart or more"),
       "%",
       1,
       100.0,
       {"difference", "vessels", "fraction_beyond_5mm"}},
      {QT_TRANSLATE_NOOP("figures", "Travel of the bar, measured"), "mm", 1, 1.0, {"contact", "travel_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Travel of the bar, atlas"), "mm", 1, 1.0, {"atlas", "contact", "travel_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Force along the hoist"), "N", 2, 1.0, {"contact", "force_along_hoist_N"}},
      {QT_TRANSLATE_NOOP("figures", "Contact area"), "mm²", 0, 1.0, {"contact", "area_mm2"}},
      {QT_TRANSLATE_NOOP("figures", "Largest pressure"), "kPa", 1, 1.0, {"contact", "pressure_max_kPa"}},
      {QT_TRANSLATE_NOOP("figures", "Largest displacement"), "mm", 1, 1.0, {"max_displacement_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Strain, 95 % below"), "%", 1, 100.0, {"p95_strain"}},
      {QT_TRANSLATE_NOOP("figures", "Largest rotation"), "°", 1, 1.0, {"max_rotation_deg"}},
      {QT_TRANSLATE_NOOP("figures", "Error of a place by the cells"),
       "mm",
       2,
       1.0,
       {"discretisation_error", "mean_mm"}},
      {QT_TRANSLATE_NOOP("figures", "Unknowns"), "", 0, 1.0, {"model", "dofs"}},
  };
  return all;
}

std::optional<double> numberAt(const Json& record, const Place& place) {
  const Json* at = &record;
  for (const char* key : place.keys) {
    if (!at->is_object() || !at->contains(key)) return {};
    at = &(*at)[key];
  }
  return at->is_number() ? std::optional<double>(place.factor * at->get<double>()) : std::nullopt;
}

Json parsed(const RunRecord& run) {
  Json j = Json::parse(run.json, nullptr, false);
  if (!j.is_object() || j.value("schema", "") != "glisson/run/1")
    throw BadInput("the file run.json is not the record of a run; run the scene again");
  return j;
}

/// Leaves of the scene by their path; lists as a whole, so that a bar laid elsewhere is one setting.
void leaves(const Json& j, const std::string& path, std::map<std::string, std::string>& into) {
  if (j.is_object()) {
    for (const auto& [key, value] : j.items()) leaves(value, path.empty() ? key : path + "." + key, into);
  } else if (j.is_array() && std::any_of(j.begin(), j.end(), [](const Json& e) { return e.is_object(); })) {
    for (std::size_t n = 0; n < j.size(); ++n) leaves(j[n], path + "[" + std::to_string(n + 1) + "]", into);
  } else {
    into[path] = j.is_string() ? j.get<std::string>() : j.dump();
  }
}

std::map<std::string, std::string> settingsOf(const Json& record) {
  std::map<std::string, std::string> all;
  if (record.contains("parameters")) leaves(record["parameters"], {}, all);
  return all;
}

std::string digestOf(const Json& record, const std::string& input) {
  if (!record.contains("inputs") || !record["inputs"].contains(input)) return {};
  return record["inputs"][input].value("sha256", "");
}

}  // namespace

std::string readRunRecord(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& file :
       {folder, folder / "run.json", folder / "results" / "run.json", folder / lastRunName / "results" / "run.json"}) {
    if (!fs::is_regular_file(file, ignored)) continue;
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw BadInput("the record of the run cannot be read");
    parsed({text.str(), {}});
    return text.str();
  }
  throw BadInput("the folder holds no run (run.json), and no case that keeps one");
}

bool RunsBeside::samePatient() const {
  return std::find(inputs.begin(), inputs.end(), "mri") == inputs.end();
}

RunsBeside beside(const RunRecord& first, const RunRecord& second) {
  const Json a = parsed(first), b = parsed(second);
  RunsBeside out;
  for (const Place& place : places()) {
    FigureBeside figure{place.words, place.unit, place.decimals, numberAt(a, place), numberAt(b, place)};
    if (figure.first || figure.second) out.figures.push_back(figure);
  }
  const auto left = settingsOf(a), right = settingsOf(b);
  const auto textIn = [](const std::map<std::string, std::string>& all, const std::string& key) {
    const auto found = all.find(key);
    return found == all.end() ? std::string() : found->second;
  };
  std::map<std::string, std::string> keys = left;
  keys.insert(right.begin(), right.end());
  for (const auto& [key, value] : keys)
    if (textIn(left, key) != textIn(right, key)) out.settings.push_back({key, textIn(left, key), textIn(right, key)});
  for (const char* input : {"mri", "mre", "roi", "map", "mask"})
    if (digestOf(a, input) != digestOf(b, input)) out.inputs.emplace_back(input);
  return out;
}

RunHistory::RunHistory(Session& session, QObject* parent) : QObject(parent), session_(session) {
  connect(&session_, &Session::runFinished, this,
          [this] { add(tr("Run at %1").arg(QTime::currentTime().toString(QStringLiteral("HH:mm:ss")))); });
  connect(&session_, &Session::loaded, this, [this] {
    if (session_.path() != path_) {
      path_ = session_.path();
      runs_.clear();
      emit changed();
    }
    if (session_.result()) add(tr("Run kept in the case"));
  });
}

void RunHistory::add(const QString& name) {
  const auto result = session_.result();
  if (!result || result->json.empty() || (!runs_.empty() && runs_.front().json == result->json)) return;
  runs_.insert(runs_.begin(), {result->json, name});
  if (runs_.size() > kept) runs_.resize(kept);
  emit changed();
}

}  // namespace glisson::session
