// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/case_folder.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "base/version.h"

namespace glisson::pipeline {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;  // keys in alphabetical order: the digest does not depend on how they were set
constexpr const char* schema = "glisson/case/1";
constexpr const char* files[] = {"contours.json", "scene.json", "case.json"};

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

fs::path folderOf(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) return file;
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

bool isVersion(const fs::path& folder) {
  return fs::absolute(folder).lexically_normal().parent_path().filename() == "versions";
}

fs::path versionFolder(const fs::path& folder, int version) {
  std::string name = std::to_string(version);
  name.insert(0, name.size() < 6 ? 6 - name.size() : 0, '0');
  return folder / "versions" / name;
}

/// A file of the case, as it was when the case was saved. Where the saving after that was broken off, it is in the
/// version that was kept before it began: for that, case.json must be the same there to the last byte.
std::string readChecked(const fs::path& folder, const Json& entry, const std::string& record, int version) {
  const auto name = entry.at("file").get<std::string>();
  if (name.find('/') != std::string::npos || name == "..") throw BadInput("case.json names a file outside its folder");
  const auto wanted = entry.at("sha256").get<std::string>();
  std::error_code error;
  if (fs::exists(folder / name, error))
    if (const std::string text = readWhole(folder / name); digestOf(text) == wanted) return text;
  const fs::path kept = versionFolder(folder, version);
  if (fs::exists(kept / "case.json", error) && readWhole(kept / "case.json") == record)
    if (const std::string text = readWhole(kept / name); digestOf(text) == wanted) return text;
  if (!fs::exists(folder / name, error)) throw BadInput("'" + name + "' of the case is missing");
  throw BadInput("'" + name + "' is not as it was saved (its SHA-256 differs): damaged, or changed by hand");
}

CaseText parse(const fs::path& folder) {
  CaseText text;
  text.record = readWhole(folder / "case.json");
  Json j;
  try {
    j = Json::parse(text.record);
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'case.json' is not valid JSON: damaged, or no case");
  }
  if (!j.is_object() || !j.contains("schema") || j["schema"] != schema)
    throw BadInput(std::string("'case.json' is not of schema ") + schema + "; it was written by another version");
  if (!j.contains("sha256") || j["sha256"] != digestOf(j))
    throw BadInput("'case.json' is not as it was saved (its SHA-256 differs): damaged, or changed by hand");
  try {
    text.version = j.at("version").get<int>();
    text.contours = readChecked(folder, j.at("contours"), text.record, text.version);
    text.scene = readChecked(folder, j.at("scene"), text.record, text.version);
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'case.json' lacks what a case needs, or holds it in another form; it was changed by hand");
  }
  return text;
}

std::optional<int> versionIn(const fs::path& folder) {
  try {
    return Json::parse(readWhole(folder / "case.json")).at("version").get<int>();
  } catch (const std::exception&) {
    return std::nullopt;  // damaged or not there: nothing to keep
  }
}

/// Puts what is there now into versions/<n>/ and lets the oldest go. Only what is whole is kept: a case that was broken
/// off while it was saved must not replace the version that is.
void keepPrevious(const fs::path& folder) {
  const std::optional<int> version = versionIn(folder);
  if (!version) return;
  const fs::path kept = versionFolder(folder, *version), making = folder / "versions" / ".making";
  std::error_code error;
  if (fs::exists(kept, error)) return;
  CaseText before;
  try {
    before = parse(folder);
  } catch (const std::exception&) {
    return;  // what is whole of it is in versions already
  }
  fs::remove_all(making, error);
  fs::create_directories(making, error);
  if (error)
    throw BadInput("the version before cannot be kept in 'versions': " + error.message() +
                   "; check the folder's rights and the free space");
  writeAtomically(making / "contours.json", before.contours);
  writeAtomically(making / "scene.json", before.scene);
  writeAtomically(making / "case.json", before.record);
  fs::rename(making, kept, error);
  const std::vector<fs::path> all = versionsOf(folder);
  for (std::size_t i = 0; i + keptVersions < all.size(); ++i) fs::remove_all(all[i], error);
}

/// What killed savings left beside the files.
void removeLeftovers(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    for (const char* file : files)
      if (entry.path().filename().string().rfind(std::string(file) + ".part", 0) == 0) fs::remove(entry.path(), error);
}

std::string wholeVersion(const fs::path& folder) {
  const std::vector<fs::path> versions = versionsOf(folder);
  for (auto it = versions.rbegin(); it != versions.rend(); ++it) {
    try {
      parse(*it);
      return "; the newest version that is whole is versions/" + it->filename().string();
    } catch (const std::exception&) {
      continue;  // damaged as well: an older one may be whole
    }
  }
  return "; there is no older version that is whole";
}

/// A path of the scene that lies in the patient's folder as that was, where it is now.
void follow(Json& geometry, const char* key, const fs::path& was, const fs::path& now) {
  if (!geometry.contains(key) || !geometry[key].is_string()) return;
  const fs::path relative = fs::path(geometry[key].get<std::string>()).lexically_relative(was);
  if (relative.empty() || *relative.begin() == "..") return;
  geometry[key] = relative == "." ? now.generic_string() : (now / relative).generic_string();
}

}  // namespace

bool isCase(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return fs::is_regular_file(path / "case.json", error);
  return path.filename() == "case.json" && fs::is_regular_file(path, error);
}

int writeCase(const CaseText& text, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw BadInput("cannot make the case folder; choose a place that can be written to");
  keepPrevious(folder);
  removeLeftovers(folder);
  int version = versionIn(folder).value_or(0) + 1;
  // Where case.json is damaged its number is taken from the versions: none is ever used twice.
  const std::vector<fs::path> all = versionsOf(folder);
  if (!all.empty()) version = std::max(version, std::atoi(all.back().filename().c_str()) + 1);
  Json j = Json::parse(text.record);
  j["schema"] = schema;
  j["written_by"] = glisson::version();
  j["saved"] = nowUtc();
  j["version"] = version;
  j["contours"] = {{"file", "contours.json"}, {"sha256", digestOf(text.contours)}};
  j["scene"] = {{"file", "scene.json"}, {"sha256", digestOf(text.scene)}};
  j["sha256"] = digestOf(j);
  writeAtomically(folder / "contours.json", text.contours);
  writeAtomically(folder / "scene.json", text.scene);
  writeAtomically(folder / "case.json", j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return version;
}

CaseText readCase(const fs::path& file) {
  const fs::path folder = folderOf(file);
  try {
    return parse(folder);
  } catch (const BadInput& e) {
    throw BadInput(std::string(e.what()) + (isVersion(folder) ? "" : wholeVersion(folder)));
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

fs::path patientOf(const CaseText& text, const fs::path& file) {
  const Json patient = Json::parse(text.record).value("patient", Json::object());
  // A version lies two folders below its case, and was written there.
  fs::path folder = folderOf(file);
  if (isVersion(folder)) folder = folder / ".." / "..";
  const auto relative = patient.value("source_relative", std::string());
  std::error_code error;
  if (!relative.empty() && fs::exists(folder / relative, error)) return fs::weakly_canonical(folder / relative, error);
  return patient.value("source", std::string());
}

Scene sceneOfCase(const fs::path& file) {
  const fs::path own = folderOf(file);
  const CaseText text = readCase(own);
  const fs::path folder = isVersion(own) ? own / ".." / ".." : own;
  Json scene;
  try {
    scene = Json::parse(text.scene);
    const fs::path was = Json::parse(text.record).at("patient").at("source").get<std::string>();
    const fs::path now = patientOf(text, own);
    if (std::error_code error; !fs::exists(now, error))
      throw BadInput("the images of this case are not where they were; put them back, or beside the case as before");
    if (scene.contains("geometry") && scene["geometry"].is_object()) {
      for (const char* key : {"mri", "mre"}) follow(scene["geometry"], key, was, now);
      // Outlines of a version, and those of a saving that was broken off, are in versions/.
      const fs::path kept = versionFolder(own, text.version);
      std::error_code error;
      const bool here = fs::exists(own / "contours.json", error) && readWhole(own / "contours.json") == text.contours;
      if (scene["geometry"].contains("roi"))
        scene["geometry"]["roi"] = fs::absolute((here ? own : kept) / "contours.json").generic_string();
    }
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'case.json' lacks what a case needs, or holds it in another form; it was changed by hand");
  }
  return parseScene(scene.dump(1), folder, "scene.json");
}

}  // namespace glisson::pipeline
