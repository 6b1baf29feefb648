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
  return j.contains("difference") && j["difference"].is_object() && j["difference"].contains(key) && j["difference"][key].is_number()
             ? j["difference"][key].get<double>()
             : none;
}

/// Words between quotation marks that are the program's own: none of them comes out of a patient's files.
bool ownWord(const std::string& word) {
  static constexpr std::array own = {"anatomical", "magnitude",  "wave",     "stiffness", "confidence", "colour-copy",
                                     "other",      "phase",      "liver",    "mri",       "mre",        "roi",
                                     "mask",       "scene.json", "mri_dir",  "Pa",        "kPa",        "shear",
                                     "youngs",     "sop_instance_uid",       "polygons",  "points_lps_mm"};
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
  const PrivateFolder work;
  const int parallel = options.jobs > 0 ? options.jobs : jobsThatFit(expectedPeak_MB);
  const std::string threads = std::to_string(threadsEach(parallel));
  struct Task {
    std::string id, variation, key;
    bool pictures = false;
  };
  std::vector<Task> tasks;
  std::vector<Job> jobs;
  // What a patient's variations gave, by name; kept beside the result so that another call goes on from there.
  std::map<std::string, Json> known;
  const auto cacheOf = [&](const std::string& id) { return options.output / "cases" / id / "chosen.json"; };
  for (const Chosen& c : summary.chosen) {
    const auto scene = scenes.find(c.id);
    if (scene == scenes.end()) continue;
    const auto record = std::find_if(summary.records.begin(), summary.records.end(),
                                     [&](const CaseRecord& r) { return r.outcome.id == c.id; });
    Json cache = fs::is_regular_file(cacheOf(c.id)) ? Json::parse(readWhole(cacheOf(c.id)), nullptr, false) : Json();
    if (!cache.is_object()) cache = Json::object();
    Json kept = Json::object();
    std::vector<Variation> list = variations(scene->second);
    if (!options.sensitivity) list.resize(1);
    for (const Variation& v : list) {
      const std::string key = keyOf(v.scene, record->key);
      const bool first = v.name == list.front().name;
      bool have = cache.contains(v.name) && cache[v.name].value("key", "") == key;
      for (const char* name : shown)
        have = have && (!first || cache[v.name].contains("no_picture") ||
                        fs::is_regular_file(options.output / "figures" / (c.id + "-" + name)));
      if (have) {
        kept[v.name] = cache[v.name];
        continue;
      }
      Json text = Json::parse(v.scene);
      text["outputs"] = first ? Json::array({"vessels", "overlay"}) : Json::array();
      const std::string name = c.id + "-" + std::to_string(jobs.size());
      writeWhole(work.path() / (name + ".json"), text.dump(1));
      tasks.push_back({c.id, v.name, key, first});
      jobs.push_back({c.id + ", " + v.name,
                      {"run", (work.path() / (name + ".json")).string(), "--output", (work.path() / name).string(),
                       "--json", "--quiet", "--threads", threads}});
    }
    known[c.id] = kept;
  }
  runJobs(
      options.executable, jobs, parallel,
      [&](std::size_t i, const JobOutcome& o) {
        const Task& t = tasks[i];
        const Json j = o.exitCode == 0 ? Json::parse(o.standardOutput, nullptr, false) : Json();
        Json result = {{"key", t.key}, {"mean_mm", nullptr}, {"at_retractor_mm", nullptr}};
        if (j.is_object()) {
          result["mean_mm"] = at(j, "mean_mm");
          result["at_retractor_mm"] = at(j, "at_retractor_mm");
        }
        if (const std::string why = noPictureBecause(j); t.pictures && !why.empty()) result["no_picture"] = why;
        if (t.pictures) {
          const fs::path drawn = jobs[i].arguments[3];
          fs::create_directories(options.output / "figures");
          for (const char* name : shown)
            if (fs::is_regular_file(drawn / name))
              fs::copy_file(drawn / name, options.output / "figures" / (t.id + "-" + name),
                            fs::copy_options::overwrite_existing);
        }
        std::error_code ignored;
        fs::remove_all(jobs[i].arguments[3], ignored);
        known[t.id][t.variation] = result;
        writeWhole(cacheOf(t.id), known[t.id].dump(1) + "\n");
      },
      progress);

  for (const Chosen& c : summary.chosen) {
    const auto scene = scenes.find(c.id);
    if (scene == scenes.end()) continue;
    Json ordered = Json::object();
    for (const Variation& v : variations(scene->second)) {
      if (!known[c.id].contains(v.name)) continue;
      ordered[v.name] = known[c.id][v.name];
      if (ordered[v.name].contains("no_picture")) summary.pictureNotes[c.id] = ordered[v.name]["no_picture"];
      const auto value = [&](const char* key) {
        const Json& x = ordered[v.name][key];
        return x.is_number() ? x.get<double>() : none;
      };
      summary.sensitivity.push_back({v.name, c.id, value("mean_mm"), value("at_retractor_mm")});
    }
    writeWhole(cacheOf(c.id), ordered.dump(1) + "\n");
    for (const char* name : shown)
      if (fs::is_regular_file(options.output / "figures" / (c.id + "-" + name)))
        summary.pictures[c.id].push_back(options.output / "figures" / (c.id + "-" + name));
  }
}

}  // namespace glisson::cohort::detail
