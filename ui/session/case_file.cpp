#include "session/case_file.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/sha256.h"
#include "base/version.h"
#include "roi/contour_io.h"
#include "session/atomic_file.h"
#include "session/marks_json.h"
#include "session/parameters_json.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;  // keys in alphabetical order: the digest does not depend on how they were set
constexpr const char* schema = "glisson/case/1";

std::string digestOf(const std::string& text) {
  return sha256(text.data(), text.size());
}

/// The digest of a case is over everything in it but itself.
std::string digestOf(Json record) {
  record.erase("sha256");
  return digestOf(record.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string nowUtc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::optional<int> versionOf(const fs::path& folder) {
  try {
    return Json::parse(readWhole(folder / "case.json")).at("version").get<int>();
  } catch (const std::exception&) {
    return std::nullopt;  // damaged or not there: nothing to keep
  }
}

CaseRecord parse(const fs::path& folder);

/// Puts what is there now into versions/<n>/ and lets the oldest go. Only what is whole is kept: a case that was broken
/// off while it was saved must not replace the version that is.
void keepPrevious(const fs::path& folder) {
  const std::optional<int> version = versionOf(folder);
  if (!version) return;
  try {
    parse(folder);
  } catch (const std::exception&) {
    return;  // what is whole of it is in versions already
  }
  std::string name = std::to_string(*version);
  name.insert(0, name.size() < 6 ? 6 - name.size() : 0, '0');
  const fs::path kept = folder / "versions" / name, making = folder / "versions" / ".making";
  std::error_code error;
  if (fs::exists(kept, error)) return;
  fs::remove_all(making, error);
  fs::create_directories(making, error);
  if (error)
    throw BadInput("the version before cannot be kept in 'versions': " + error.message() +
                   "; check the folder's rights and the free space");
  for (const char* file : {"contours.json", "scene.json", "case.json"})
    writeAtomically(making / file, readWhole(folder / file));
  fs::rename(making, kept, error);
  const std::vector<fs::path> all = versionsOf(folder);
  for (std::size_t i = 0; i + keptVersions < all.size(); ++i) fs::remove_all(all[i], error);
}

fs::path sourceOf(const Json& patient, const fs::path& folder) {
  const auto relative = patient.value("source_relative", std::string());
  std::error_code error;
  if (!relative.empty() && fs::exists(folder / relative, error)) return fs::weakly_canonical(folder / relative, error);
  return patient.value("source", std::string());
}

std::string wholeVersion(const fs::path& folder) {
  const std::vector<fs::path> versions = versionsOf(folder);
  for (auto it = versions.rbegin(); it != versions.rend(); ++it) {
    try {
      readCaseRecord(*it);
      return "; the newest version that is whole is versions/" + it->filename().string();
    } catch (const std::exception&) {
      continue;  // damaged as well: an older one may be whole
    }
  }
  return "; there is no older version that is whole";
}

/// A file of the case, as it was when the case was saved.
std::string readChecked(const fs::path& folder, const Json& entry) {
  const auto name = entry.at("file").get<std::string>();
  if (name.find('/') != std::string::npos || name == "..") throw BadInput("case.json names a file outside its folder");
  const std::string text = readWhole(folder / name);
  if (digestOf(text) != entry.at("sha256").get<std::string>())
    throw BadInput("'" + name + "' is not as it was saved (its SHA-256 differs): damaged, or changed by hand");
  return text;
}

CaseRecord parse(const fs::path& folder) {
  Json j;
  try {
    j = Json::parse(readWhole(folder / "case.json"));
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'case.json' is not valid JSON: damaged, or no case");
  }
  if (!j.is_object() || j.value("schema", std::string()) != schema)
    throw BadInput(std::string("'case.json' is not of schema ") + schema + "; it was written by another version");
  if (j.value("sha256", std::string()) != digestOf(j))
    throw BadInput("'case.json' is not as it was saved (its SHA-256 differs): damaged, or changed by hand");
  CaseRecord record;
  const std::string contours = readChecked(folder, j.at("contours"));
  static_cast<roi::ContourStack&>(record.outlines) = roi::contoursFromJson(contours, "contours.json");
  record.outlines.marks = marksFromJson(j.at("slices"));
  record.sceneJson = readChecked(folder, j.at("scene"));
  record.source = sourceOf(j.at("patient"), folder);
  record.seriesUid = j.at("patient").value("series_uid", std::string());
  for (const auto& [uid, role] : j.at("patient").at("roles").items())
    record.roles[uid] = dicom::roleNamed(role.get<std::string>());
  record.parameters = parametersFromJson(j.at("parameters"));
  record.measure.innerRoi = j.at("measure").at("inner_roi").get<bool>();
  record.measure.erosion_pixels = std::clamp(j.at("measure").at("erosion_pixels").get<int>(), 0, 50);
  record.version = j.at("version").get<int>();
  return record;
}

}  // namespace

int writeCaseRecord(const CaseRecord& record, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw BadInput("cannot make the case folder; choose a place that can be written to");
  keepPrevious(folder);
  int version = versionOf(folder).value_or(0) + 1;
  // Where case.json is damaged its number is taken from the versions: none is ever used twice.
  const std::vector<fs::path> all = versionsOf(folder);
  if (!all.empty()) version = std::max(version, std::atoi(all.back().filename().c_str()) + 1);
  const std::string contours = roi::toJson(record.outlines);
  Json roles = Json::object();
  for (const auto& [uid, role] : record.roles) roles[uid] = dicom::name(role);
  const fs::path relative = fs::relative(record.source, folder, error);
  Json j = {{"schema", schema},
            {"written_by", glisson::version()},
            {"saved", nowUtc()},
            {"version", version},
            {"patient",
             {{"source", record.source.string()},
              {"source_relative", error ? std::string() : relative.string()},
              {"series_uid", record.seriesUid},
              {"roles", roles}}},
            {"contours", {{"file", "contours.json"}, {"sha256", digestOf(contours)}}},
            {"scene", {{"file", "scene.json"}, {"sha256", digestOf(record.sceneJson)}}},
            {"slices", marksToJson(record.outlines.marks)},
            {"measure", {{"inner_roi", record.measure.innerRoi}, {"erosion_pixels", record.measure.erosion_pixels}}},
            {"parameters", toJson(record.parameters)}};
  j["sha256"] = digestOf(j);
  writeAtomically(folder / "contours.json", contours);
  writeAtomically(folder / "scene.json", record.sceneJson);
  writeAtomically(folder / "case.json", j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return version;
}

CaseRecord readCaseRecord(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::is_directory(file, error) ? file : file.parent_path();
  try {
    return parse(folder);
  } catch (const nlohmann::json::exception& e) {
    throw BadInput("'case.json' lacks what a case needs, or holds it in another form; it was changed by hand");
  } catch (const BadInput& e) {
    const bool isVersion = folder.parent_path().filename() == "versions";
    throw BadInput(std::string(e.what()) + (isVersion ? "" : wholeVersion(folder)));
  }
}

std::vector<fs::path> versionsOf(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / "versions", error))
    if (entry.path().filename() != ".making") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

bool isCase(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return fs::is_regular_file(path / "case.json", error);
  return path.filename() == "case.json" && fs::is_regular_file(path, error);
}

}  // namespace glisson::session
