// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/patients.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "base/quantity_names.h"
#include "base/sha256.h"
#include "base/text.h"
#include "dicom/series.h"
#include "image/io.h"
#include "pipeline/scene.h"

namespace glisson::cohort {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied))
    if (entry.is_regular_file() && !entry.is_symlink()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool looksLikeMask(const fs::path& file) {
  if (!image::isVolumeFile(file)) return false;
  const std::string name = lowerCase(file.filename().string());
  for (const char* word : {"roi", "mask", "liver", "seg"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

fs::path findRegion(const fs::path& folder) {
  for (const char* name : {"roi.json", "contours.json"})
    if (fs::is_regular_file(folder / name)) return folder / name;
  // Contours drawn elsewhere: the scan skips them as images and says what they are.
  const dicom::ScanResult scan = dicom::scan(folder);
  for (const char* kind : {"RT Structure Set", "Segmentation"})
    for (const dicom::SkippedFile& f : scan.skipped)
      if (f.reason.find(std::string("is ") + (kind[0] == 'R' ? "an " : "a ") + kind) != std::string::npos)
        return f.file;
  for (const fs::path& f : filesBelow(folder))
    if (looksLikeMask(f)) return f;
  throw BadInput(
      "no region of interest was found; put contours (RT Structure Set, roi.json) or a mask (*mask*.nii.gz) "
      "into the patient's folder");
}

/// What the paper simulates: springs over the posterior and superior surface, the liver's weight on a 10 mm bar.
Json paperRetraction() {
  return Json::parse(R"({
    "schema": "glisson/scene/1", "geometry": {}, "material": "mre",
    "supports": [
      {"region": {"surface": "posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1},
      {"region": {"surface": "superior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1}],
    "loads": [{"kind": "retractor", "diameter_mm": 10, "length_mm": 80, "at": "inferior-right-lobe",
               "force": "liver-weight", "direction": "transverse"}],
    "model": {"kind": "fem-hex"}, "compare": {"against": "atlas"}, "seed": 1})");
}

std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw BadInput("cannot read '" + file.filename().string() + "'");
  return text.str();
}

void eachPath(Json& j, const std::function<void(Json&)>& fn) {
  for (auto& [key, value] : j.items()) {
    if (value.is_structured())
      eachPath(value, fn);
    else if (value.is_string() &&
             (key == "mri" || key == "mre" || key == "roi" || key == "file" || key == "map" || key == "mask"))
      fn(value);
  }
}

/// The region and the stiffness mean the same to `measure` as to `run`.
PatientFiles filesOf(const pipeline::Scene& scene) {
  const pipeline::GeometrySpec& g = scene.geometry;
  PatientFiles files{g.mri, g.mre, g.roi};
  const auto say = [&](std::initializer_list<std::string> words) {
    files.meaning.insert(files.meaning.end(), words.begin(), words.end());
  };
  if (scene.material.kind == pipeline::MaterialSpec::Kind::Map) {
    files.mre = scene.material.map;
    say({"--quantity", stiffnessQuantityNames.nameOf(scene.material.quantity)});
    say({"--unit", scene.material.unit});
  }
  if (g.label != 0) say({"--label", std::to_string(g.label)});
  if (!g.roiName.empty()) say({"--name", g.roiName});
  for (const auto& [series, role] : g.roles) say({"--role", series + "=" + dicom::name(role)});
  if (g.overrideChecks) say({"--override"});
  if (g.rigidRegistration && scene.material.kind == pipeline::MaterialSpec::Kind::Mre) say({"--register"});
  return files;
}

}  // namespace

std::string withoutPaths(const std::string& sceneJson) {
  Json j = Json::parse(sceneJson);
  eachPath(j, [](Json& path) { path = "(file)"; });
  return j.dump(1);
}

std::vector<PatientFolder> findPatients(const fs::path& cohort) {
  if (!fs::is_directory(cohort))
    throw BadInput("the cohort must be a folder that holds one folder per patient; this one is not there");
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(cohort)) {
    if (!entry.is_directory() || entry.is_symlink() || entry.path().filename().string().front() == '.') continue;
    if (!filesBelow(entry.path()).empty()) folders.push_back(fs::absolute(entry.path()));
  }
  if (folders.empty())
    throw BadInput(
        "no patient was found: the cohort's folder must hold one folder per patient, with files in it; links are not "
        "followed");
  std::sort(folders.begin(), folders.end());
  const std::size_t digits = std::max<std::size_t>(3, std::to_string(folders.size()).size());
  std::vector<PatientFolder> out;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    out.push_back({static_cast<int>(i + 1), "case-" + std::string(digits - number.size(), '0') + number, folders[i]});
  }
  return out;
}

std::string digestOfFolder(const fs::path& folder) {
  std::string all;
  for (const fs::path& f : filesBelow(folder))
    all += f.lexically_relative(folder).generic_string() + '\0' + sha256OfFile(f) + '\n';
  return sha256(all.data(), all.size());
}

PatientFiles findFiles(const fs::path& folder) {
  if (fs::is_regular_file(folder / "scene.json")) {
    const pipeline::Scene scene = pipeline::readScene(folder / "scene.json");
    if (scene.geometry.kind != pipeline::GeometrySpec::Kind::Patient)
      throw BadInput("the patient's scene.json must have a geometry of kind \"patient\" (mri, mre, roi)");
    return filesOf(scene);
  }
  return {folder, folder, findRegion(folder)};
}

std::string sceneOf(const fs::path& folder, const std::optional<std::string>& sceneTemplate) {
  const bool own = fs::is_regular_file(folder / "scene.json");
  Json j;
  if (sceneTemplate)
    j = Json::parse(*sceneTemplate, nullptr, true, true);
  else
    j = own ? Json::parse(readText(folder / "scene.json"), nullptr, true, true) : paperRetraction();
  const PatientFiles files = findFiles(folder);
  Json geometry = own ? Json::parse(readText(folder / "scene.json"), nullptr, true, true)["geometry"] : Json::object();
  geometry["kind"] = "patient";
  if (!own) {
    geometry["mri"] = files.mri.string();
    geometry["mre"] = files.mre.string();
    geometry["roi"] = files.roi.string();
  }
  for (const char* name : {"mri", "mre", "roi"})
    if (geometry.contains(name) && geometry[name].is_string())
      geometry[name] = fs::absolute(folder / geometry[name].get<std::string>()).string();
  j["geometry"] = geometry;
  j["outputs"] = Json::array();
  if (!j.contains("compare")) j["compare"] = {{"against", "atlas"}};
  // Read once, so that a bad scene is refused here and every default is written out.
  Json whole = Json::parse(pipeline::toJson(pipeline::parseScene(j.dump(), folder)));
  // The scene is run from another folder than the patient's.
  eachPath(whole, [&](Json& path) {
    const fs::path p = path.get<std::string>();
    if (p.is_relative()) path = fs::absolute(folder / p).lexically_normal().string();
  });
  return whole.dump(2);
}

}  // namespace glisson::cohort
