// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/sha256.h"
#include "base/version.h"
#include "cohort/detail/summary.h"
#include "cohort/processes.h"

namespace glisson::cohort::detail {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Why a run drew no picture; empty where it does not say.
std::string noPictureBecause(const Json& run) {
  if (run.is_object() && run.contains("warnings"))
    for (const Json& w : run["warnings"])
      if (w.is_string() && w.get<std::string>().rfind("no picture is drawn", 0) == 0) return w;
  return {};
}

/// The pictures that the report shows, of those a run draws.
constexpr std::array<const char*, shownPictures> shown = {"overlay-retractor.png", "overlay-largest-difference.png",
                                                          "overlay-3d-anterior.png"};

std::string keyOf(const std::string& scene, const std::string& recordKey) {
  const std::string all = recordKey + withoutPaths(scene) + version();
  return sha256(all.data(), all.size());
}

double at(const Json& j, const char* key) {
  return j.contains("difference") && j["difference"].is_object() && j["difference"].contains(key) &&
                 j["difference"][key].is_number()
             ? j["difference"][key].get<double>()
             : none;
}

/// Words between quotation marks that are the program's own: none of them comes out of a patient's files.
bool ownWord(const std::string& word) {
  static constexpr std::array own = {"anatomical",  "magnitude",    "wave",  "stiffness",  "confidence",
                                     "colour-copy", "other",        "phase", "liver",      "mri",
                                     "mre",         "roi",          "mask",  "scene.json", "mri_dir",
                                     "Pa",          "kPa",          "shear", "youngs",     "sop_instance_uid",
                                     "polygons",    "points_lps_mm"};
  return word.starts_with("--") || std::find(own.begin(), own.end(), word) != own.end();
}

/// What stands between quotation marks may be the name of a file, a structure, a segment or a series, and those are
/// often made of the patient's: it is left out, unless it is the patient's number
/// in the study or one of the program's own words.
std::string withoutQuotedNames(const std::string& message, const std::string& id) {
  const auto letter = [&](std::size_t at) {
    return at < message.size() && (std::isalnum(static_cast<unsigned char>(message[at])) || (message[at] & 0x80));
  };
  std::string out;
  for (std::size_t p = 0; p < message.size();) {
    if (message[p] != '\'' || (p > 0 && letter(p - 1))) {
      out += message[p++];
      continue;
    }
    std::size_t end = message.find('\'', p + 1);
    while (end != std::string::npos && letter(end + 1)) end = message.find('\'', end + 1);
    if (end == std::string::npos) {
      out += message[p++];
      continue;
    }
    const std::string word = message.substr(p + 1, end - p - 1);
    out += word == id || ownWord(word) ? "'" + word + "'" : "(a name)";
    p = end + 1;
  }
  return out;
}

/// The chosen patients run again: what is known of each of their variations, and what is still to be run.
class ChosenRuns {
 public:
  ChosenRuns(Summary& summary, const std::map<std::string, std::string>& scenes, const CohortOptions& options)
      : summary_(summary), scenes_(scenes), options_(options) {}

  /// Takes over what an earlier call has left, and makes a job of everything else.
  void collect();
  /// Runs the jobs; each result is kept as soon as it is there.
  void run(const Progress& progress);
  /// Gives the summary what is known, in the order of the variations.
  void report();

 private:
  struct Task {
    std::string id, variation, key;
    bool pictures = false;
  };

  fs::path cacheOf(const std::string& id) const { return options_.output / "cases" / id / "chosen.json"; }
  fs::path pictureOf(const std::string& id, const char* name) const {
    return options_.output / "figures" / (id + "-" + name);
  }
  /// What earlier calls know of a patient's variations; an empty object where there is nothing.
  Json readCache(const std::string& id) const;
  /// Whether a kept result is that of the same variation, with its pictures where it has any.
  bool holds(const Json& cache, const std::string& id, const Variation& v, const std::string& key, bool first) const;
  void addJob(const std::string& id, const Variation& v, const std::string& key, bool first);
  void keepResult(std::size_t job, const JobOutcome& outcome);

  Summary& summary_;
  const std::map<std::string, std::string>& scenes_;
  const CohortOptions& options_;
  const PrivateFolder work_;
  const int parallel_ = options_.jobs > 0 ? options_.jobs : jobsThatFit(expectedPeak_MB);
  std::vector<Task> tasks_;
  std::vector<Job> jobs_;  ///< one per task
  /// What a patient's variations gave, by name; kept in the patient's folder so that another call goes on from there.
  std::map<std::string, Json> known_;
};

Json ChosenRuns::readCache(const std::string& id) const {
  Json cache = fs::is_regular_file(cacheOf(id)) ? Json::parse(readWhole(cacheOf(id)), nullptr, false) : Json();
  return cache.is_object() ? cache : Json::object();
}

bool ChosenRuns::holds(const Json& cache, const std::string& id, const Variation& v, const std::string& key,
                       bool first) const {
  if (!cache.contains(v.name) || cache[v.name].value("key", "") != key) return false;
  if (!first || cache[v.name].contains("no_picture")) return true;
  return std::all_of(shown.begin(), shown.end(),
                     [&](const char* name) { return fs::is_regular_file(pictureOf(id, name)); });
}

void ChosenRuns::addJob(const std::string& id, const Variation& v, const std::string& key, bool first) {
  Json text = Json::parse(v.scene);
  text["outputs"] = first ? Json::array({"vessels", "overlay"}) : Json::array();
  const std::string name = id + "-" + std::to_string(jobs_.size());
  writeWhole(work_.path() / (name + ".json"), text.dump(1));
  tasks_.push_back({id, v.name, key, first});
  jobs_.push_back({id + ", " + v.name,
                   {"run", (work_.path() / (name + ".json")).string(), "--output", (work_.path() / name).string(),
                    "--json", "--quiet", "--threads", std::to_string(threadsEach(parallel_))}});
}

void ChosenRuns::collect() {
  for (const Chosen& c : summary_.chosen) {
    const auto scene = scenes_.find(c.id);
    if (scene == scenes_.end()) continue;
    const auto record = std::find_if(summary_.records.begin(), summary_.records.end(),
                                     [&](const CaseRecord& r) { return r.outcome.id == c.id; });
    const Json cache = readCache(c.id);
    Json kept = Json::object();
    std::vector<Variation> list = variations(scene->second);
    if (!options_.sensitivity) list.resize(1);
    for (const Variation& v : list) {
      const std::string key = keyOf(v.scene, record->key);
      const bool first = v.name == list.front().name;
      if (holds(cache, c.id, v, key, first))
        kept[v.name] = cache[v.name];
      else
        addJob(c.id, v, key, first);
    }
    known_[c.id] = kept;
  }
}

void ChosenRuns::keepResult(std::size_t job, const JobOutcome& o) {
  const Task& t = tasks_[job];
  const fs::path folder = jobs_[job].arguments[3];
  const Json j = o.exitCode == 0 ? Json::parse(o.standardOutput, nullptr, false) : Json();
  Json result = {{"key", t.key}, {"mean_mm", nullptr}, {"at_retractor_mm", nullptr}};
  if (j.is_object()) {
    result["mean_mm"] = at(j, "mean_mm");
    result["at_retractor_mm"] = at(j, "at_retractor_mm");
  }
  if (t.pictures) {
    if (const std::string why = noPictureBecause(j); !why.empty()) result["no_picture"] = why;
    fs::create_directories(options_.output / "figures");
    for (const char* name : shown)
      if (fs::is_regular_file(folder / name))
        fs::copy_file(folder / name, pictureOf(t.id, name), fs::copy_options::overwrite_existing);
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  known_[t.id][t.variation] = result;
  writeWhole(cacheOf(t.id), known_[t.id].dump(1) + "\n");
}

void ChosenRuns::run(const Progress& progress) {
  runJobs(
      options_.executable, jobs_, parallel_, [this](std::size_t i, const JobOutcome& o) { keepResult(i, o); },
      progress);
}

void ChosenRuns::report() {
  for (const Chosen& c : summary_.chosen) {
    const auto scene = scenes_.find(c.id);
    if (scene == scenes_.end()) continue;
    Json ordered = Json::object();
    for (const Variation& v : variations(scene->second)) {
      if (!known_[c.id].contains(v.name)) continue;
      const Json& result = ordered[v.name] = known_[c.id][v.name];
      if (result.contains("no_picture")) summary_.pictureNotes[c.id] = result["no_picture"];
      const auto value = [&](const char* key) {
        return result.contains(key) && result[key].is_number() ? result[key].get<double>() : none;
      };
      summary_.sensitivity.push_back({v.name, c.id, value("mean_mm"), value("at_retractor_mm")});
    }
    writeWhole(cacheOf(c.id), ordered.dump(1) + "\n");
    for (const char* name : shown)
      if (fs::is_regular_file(pictureOf(c.id, name))) summary_.pictures[c.id].push_back(pictureOf(c.id, name));
  }
}

}  // namespace

std::string anonymous(std::string message, const fs::path& folder, const std::string& id) {
  const std::string program = "glisson-cli: ";
  if (message.rfind(program, 0) == 0) message.erase(0, program.size());
  // A folder may be called "1": its name is replaced where it stands as a word, not inside other words and numbers.
  const auto within = [&](std::size_t at) {
    return at < message.size() && std::isalnum(static_cast<unsigned char>(message[at]));
  };
  const std::string whole = folder.string() + "/";
  for (const auto& [part, instead] : std::vector<std::pair<std::string, std::string>>{
           {whole + "'", id + "'"}, {whole, ""}, {folder.string(), id}, {folder.filename().string(), id}})
    for (std::size_t p = message.find(part); !part.empty() && p != std::string::npos; p = message.find(part, p)) {
      const bool word = part.front() == '/' || !((p > 0 && within(p - 1)) || within(p + part.size()));
      if (word) message.replace(p, part.size(), instead);
      p += word ? instead.size() : part.size();
    }
  return withoutQuotedNames(message, id);
}

void studyChosen(Summary& summary, const std::map<std::string, std::string>& scenes, const CohortOptions& options,
                 const Progress& progress) {
  ChosenRuns runs(summary, scenes, options);
  runs.collect();
  runs.run(progress);
  runs.report();
}

}  // namespace glisson::cohort::detail
