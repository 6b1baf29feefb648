// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/case_file.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "pipeline/case_folder.h"
#include "roi/contour_io.h"
#include "session/marks_json.h"
#include "session/settings_json.h"

namespace glisson::session {

using Json = nlohmann::json;

int writeCaseRecord(const CaseRecord& record, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path relative = std::filesystem::relative(record.source, folder, error);
  Json j = {{"patient",
             {{"source", record.source.string()},
              {"source_relative", error ? std::string() : relative.string()},
              {"series_uid", record.seriesUid}}},
            {"slices", marksToJson(record.outlines.marks)},
            {"measure", toJson(record.measure)},
            {"parameters", toJson(record.parameters)}};
  if (const Json made = madeToJson(record.outlines); !made.empty()) j["made"] = made;
  putChoices(record.choices, j["patient"]);
  if (record.lastRunStale) j["last_run"] = {{"stale", *record.lastRunStale}};
  return pipeline::writeCase(
      {j.dump(-1, ' ', false, Json::error_handler_t::replace), roi::toJson(record.outlines), record.sceneJson}, folder);
}

CaseRecord readCaseRecord(const std::filesystem::path& file) {
  const pipeline::CaseText text = pipeline::readCase(file);
  CaseRecord record;
  static_cast<roi::ContourStack&>(record.outlines) = roi::contoursFromJson(text.contours, "contours.json");
  record.sceneJson = text.scene;
  record.version = text.version;
  record.source = pipeline::patientOf(text, file);
  try {
    const Json j = Json::parse(text.record);
    record.outlines.marks = marksFromJson(j.at("slices"));
    if (j.contains("made")) record.outlines.made = madeFromJson(j["made"]);
    record.seriesUid = j.at("patient").value("series_uid", std::string());
    record.choices = choicesFromJson(j.at("patient"));
    if (j.contains("last_run")) record.lastRunStale = j["last_run"].at("stale").get<bool>();
    record.parameters = parametersFromJson(j.at("parameters"));
    record.measure = measureFromJson(j.at("measure"));
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'case.json' lacks what a case needs, or holds it in another form; it was changed by hand");
  }
  return record;
}

}  // namespace glisson::session
