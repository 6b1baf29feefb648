// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/replay.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "base/private_folder.h"
#include "base/sha256.h"
#include "base/version.h"
#include "pipeline/detail/record.h"
#include "pipeline/run.h"

namespace glisson::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json readJson(const std::filesystem::path& file, const char* what) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || text.str().empty())
    throw BadInput(std::string("cannot read the ") + what + " '" + file.filename().string() +
                   "'; check that it exists");
  try {
    return Json::parse(text.str(), nullptr, true, true);
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'" + file.filename().string() + "' is no " + what + ": it is not JSON");
  }
}

/// The longest end of the path that is there below the root ("moved/mri/7" for ".../mri/7"); never one beside it.
void lookBelow(const std::filesystem::path& root, Json& holder, const char* key) {
  if (!holder.is_object() || !holder.contains(key) || !holder[key].is_string()) return;
  std::vector<std::filesystem::path> parts;
  for (const auto& part : std::filesystem::path(holder[key].get<std::string>()).lexically_normal().relative_path())
    if (!part.empty() && part != "..") parts.push_back(part);
  if (parts.empty()) return;
  std::filesystem::path found;
  for (auto first = parts.begin(); first != parts.end(); ++first) {
    found = root;
    for (auto part = first; part != parts.end(); ++part) found /= *part;
    if (std::filesystem::exists(found)) break;
  }
  holder[key] = std::filesystem::absolute(found).generic_string();
}

void lookForInputsBelow(const std::filesystem::path& root, Json& scene) {
  for (const char* key : {"file", "mri", "mre", "roi"})
    if (scene.contains("geometry")) lookBelow(root, scene["geometry"], key);
  if (scene.contains("material")) lookBelow(root, scene["material"], "map");
  for (const char* list : {"supports", "loads"})
    if (scene.contains(list))
      for (Json& item : scene[list])
        if (item.is_object() && item.contains("region")) lookBelow(root, item["region"], "mask");
}

std::vector<ReplayedFile> compared(const Json& then, const Json& now) {
  std::vector<ReplayedFile> files;
  for (const Json& f : then) files.push_back({f.at("file").get<std::string>(), f.at("sha256").get<std::string>(), {}});
  for (const Json& f : now) {
    const std::string name = f.at("file").get<std::string>();
    auto at = std::find_if(files.begin(), files.end(), [&](const ReplayedFile& known) { return known.file == name; });
    if (at == files.end()) at = files.insert(at, {name, {}, {}});
    at->found = f.at("sha256").get<std::string>();
  }
  return files;
}

void requireSameInputs(const Scene& scene, const Json& recorded) {
  std::size_t known = 0;
  for (const auto& [name, digest] : detail::inputDigests(scene)) {
    if (!recorded.contains(name)) throw BadInput("the run record knows no input \"" + name + "\"; is this its scene?");
    if (recorded.at(name).at("sha256") != digest)
      throw BadInput("the input \"" + name +
                     "\" is not the one of the run: its SHA-256 differs; find the original, or run the scene anew");
    ++known;
  }
  if (known != recorded.size()) throw BadInput("the run used more inputs than the scene names; is this its scene?");
}

}  // namespace

bool ReplayResult::identical() const {
  return numbersIdentical && changed.empty() &&
         std::all_of(outputs.begin(), outputs.end(), [](const ReplayedFile& f) { return f.identical(); });
}

std::filesystem::path recordOf(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? run / "run.json" : run;
}

std::vector<std::string> filesOfAnotherRun(const std::filesystem::path& recordFile) {
  const Json record = readJson(recordFile, "run record");
  std::vector<std::string> names;
  try {
    for (const Json& f : record.at("outputs")) {
      const std::string name = f.at("file").get<std::string>();
      const std::filesystem::path beside = recordFile.parent_path() / std::filesystem::path(name).filename();
      if (std::filesystem::is_regular_file(beside) && sha256OfFile(beside) != f.at("sha256").get<std::string>())
        names.push_back(name);
    }
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'" + recordFile.filename().string() + "' is no complete run record");
  }
  return names;
}

ReplayResult replay(const std::filesystem::path& ofRun, const ReplayOptions& options, const Progress& progress) {
  const std::filesystem::path recordFile = recordOf(ofRun);
  const Json record = readJson(recordFile, "run record");
  try {
    if (record.at("schema") != "glisson/run/1" || !record.contains("results_sha256"))
      throw BadInput("'" + recordFile.filename().string() + "' is no run record that can be replayed");
    const std::filesystem::path sceneFile =
        options.scene.empty() ? recordFile.parent_path() / "scene.json" : options.scene;
    Json sceneJson = readJson(sceneFile, "scene");
    if (!options.root.empty()) lookForInputsBelow(options.root, sceneJson);
    const std::filesystem::path folder = sceneFile.parent_path();
    Scene scene = parseScene(sceneJson.dump(1), folder.empty() ? "." : folder, sceneFile.filename().string());
    if (Json::parse(detail::parameters(scene)) != record.at("parameters"))
      throw BadInput("the scene '" + sceneFile.filename().string() +
                     "' is not the one of the run record: its parameters differ; name the right one with --scene");
    requireSameInputs(scene, record.at("inputs"));

    ReplayResult result;
    if (record.at("version") != version() || record.at("commit") != buildCommit())
      result.notes.push_back("the run was made by version " + record.at("version").get<std::string>() + ", commit " +
                             record.at("commit").get<std::string>() + "; this is version " + version() + ", commit " +
                             buildCommit());
    result.changed = filesOfAnotherRun(recordFile);
    for (const std::string& name : result.changed)
      result.notes.push_back(name + " beside the record is not the file that the run has written");
    // Where no folder is asked for, the results go when the replay ends.
    std::optional<PrivateFolder> temporary;
    if (options.output.empty()) temporary.emplace();
    const std::filesystem::path& place = temporary ? temporary->path() : options.output;
    RunOptions runOptions;
    runOptions.output = place;
    runOptions.palette =
        record.at("palette") == "colour-blind" ? render::Palette::ColourBlind : render::Palette::RedBlue;
    runOptions.language = languageNamed(record.value("language", ""));
    const Json again = Json::parse(run(scene, runOptions, progress).json);
    result.numbersIdentical = again.at("results_sha256") == record.at("results_sha256");
    result.outputs = compared(record.at("outputs"), again.at("outputs"));
    return result;
  } catch (const nlohmann::json::exception&) {
    throw BadInput("'" + recordFile.filename().string() + "' is no complete run record");
  }
}

}  // namespace glisson::pipeline
