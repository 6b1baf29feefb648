// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/cohort.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/sha256.h"
#include "base/version.h"
#include "cohort/detail/summary.h"
#include "cohort/processes.h"
#include "dicom/series.h"
#include "report/text.h"

namespace glisson::cohort {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Patient {
  PatientFolder place;
  PatientFiles files;
  std::string scene;    ///< JSON; empty where it was refused
  std::string refused;  ///< why
  std::string key;      ///< digest of the files and, once asked for with options, of the scene and the program
};

/// The scene, asked how sure its answer is.
std::string withUncertainty(const std::string& scene) {
  Json j = Json::parse(scene);
  if (!j.contains("uncertainty")) j["uncertainty"] = true;
  return j.dump(2);
}

/// What lies in a patient's folder; `key` is that of its files alone.
Patient readPatient(const PatientFolder& place, const std::optional<std::string>& sceneTemplate) {
  Patient p;
  p.place = place;
  try {
    p.key = digestOfFolder(place.folder);
    p.files = findFiles(place.folder);
    p.scene = sceneOf(place.folder, sceneTemplate);
    if (!fs::is_regular_file(place.folder / "scene.json") && dicom::scan(place.folder).series.empty())
      throw BadInput(
          "no DICOM image was found; images in other formats need a scene.json in the patient's folder that names the "
          "mri, the roi and, as material, the map of stiffness with its quantity and unit");
  } catch (const BadInput& e) {
    p.scene.clear();
    p.refused = detail::anonymous(e.what(), place.folder, place.id);
  }
  return p;
}

/// The patient as the options have it run, with the key of that.
Patient asAsked(Patient p, const std::optional<std::string>& sceneTemplate, const CohortOptions& options) {
  try {
    if (options.uncertainty && !p.scene.empty()) p.scene = withUncertainty(p.scene);
  } catch (const BadInput& e) {
    p.scene.clear();
    p.refused = detail::anonymous(e.what(), p.place.folder, p.place.id);
  }
  std::string all =
      p.key + (p.scene.empty() ? "" : withoutPaths(p.scene)) + (sceneTemplate ? *sceneTemplate : "") + version();
  // A report compares vessels, whose numbers are then in the record: one cohort holds records of one kind.
  if (options.reports) all += "reports";
  p.key = sha256(all.data(), all.size());
  return p;
}

std::optional<std::string> templateText(const CohortOptions& options) {
  if (!options.scene) return {};
  if (!fs::is_regular_file(*options.scene))
    throw BadInput("the template scene is not there; give --scene a scene file");
  return readWhole(*options.scene);
}

fs::path resultOf(const fs::path& output, const std::string& id) {
  return output / "cases" / id / "result.json";
}

constexpr std::array<const char*, 3> reportFiles = {"report.html", "report.pdf", "run.json"};

fs::path reportOf(const fs::path& output, const std::string& id) {
  return output / "cases" / id / "report";
}

/// Takes what is there of a patient's report.
void keepReport(const fs::path& from, const fs::path& to) {
  for (const char* name : reportFiles)
    if (fs::is_regular_file(from / name)) writeWhole(to / name, readWhole(from / name));
}

std::string withReport(const std::string& scene) {
  Json j = Json::parse(scene);
  j["outputs"] = {"vessels", "overlay", "report"};
  return j.dump(1);
}

/// What was computed before and still holds. Failures are tried again.
std::optional<CaseRecord> stillGood(const fs::path& output, const Patient& p, bool report) {
  if (!fs::is_regular_file(resultOf(output, p.place.id))) return {};
  std::optional<CaseRecord> r = parseRecord(readWhole(resultOf(output, p.place.id)));
  if (!r || r->key != p.key || r->outcome.status == CaseOutcome::Status::Failed) return {};
  if (report && r->outcome.status == CaseOutcome::Status::Done)
    for (const char* name : reportFiles)
      if (!fs::is_regular_file(reportOf(output, p.place.id) / name)) return {};
  return r;
}

/// Why no bar holds this liver, in the words of its run; empty where that is not the reason.
std::string slipIn(const std::string& runJson) {
  const auto j = nlohmann::json::parse(runJson, nullptr, false);
  if (!j.is_object() || !j.contains("diagnostics")) return {};
  std::string why;
  for (const char* code : {"retractor-slips", "no-place-bears"})
    for (const auto& d : j["diagnostics"])
      if (d.value("code", "") == code) why += (why.empty() ? "" : "; ") + d.value("text", "");
  return why;
}

CaseOutcome outcomeOf(const std::string& id, const JobOutcome& o, const fs::path& folder) {
  CaseOutcome out;
  out.id = id;
  if (o.exitCode == 0) {
    out.status = CaseOutcome::Status::Done;
  } else if (o.exitCode == 3) {
    out.status = CaseOutcome::Status::Rejected;
    out.reason = detail::anonymous(o.message, folder, id);
  } else if (const std::string why = slipIn(o.standardOutput); !why.empty()) {
    out.status = CaseOutcome::Status::Rejected;
    out.reason = why;
  } else {
    out.status = CaseOutcome::Status::Failed;
    out.reason = o.signal != 0 ? "the program was ended by signal " + std::to_string(o.signal) +
                                     (o.signal == 9 ? " (out of memory?); try fewer --jobs" : "")
                               : detail::anonymous(o.message, folder, id);
    if (out.reason.empty()) out.reason = "the program ended with exit code " + std::to_string(o.exitCode);
  }
  return out;
}

void writeTimings(const fs::path& output, const std::map<std::string, std::pair<double, double>>& spent) {
  report::Csv csv({"case", "seconds", "peak_MB"});
  for (const auto& [id, s] : spent) csv.row({id, report::number(s.first, 4), report::number(s.second, 4)});
  writeWhole(output / "timings.csv", csv.text());
}

/// Measures and retracts every patient that has no result yet: two jobs for each, "measure" and "run".
class PatientRuns {
 public:
  PatientRuns(const std::vector<Patient>& patients, const CohortOptions& options)
      : patients_(patients), options_(options) {}

  /// One outcome per patient, in their order.
  std::vector<CaseOutcome> run(const Progress& progress);

 private:
  /// Takes over what is there already or was refused; else adds the two jobs.
  void begin(const Patient& p);
  /// Keeps what a patient's two jobs gave, and forgets the jobs.
  void keep(const Patient& p, JobOutcome& measured, JobOutcome& retracted);

  const std::vector<Patient>& patients_;
  const CohortOptions& options_;
  const PrivateFolder work_;
  const int parallel_ = options_.jobs > 0 ? options_.jobs : jobsThatFit(expectedPeak_MB);
  std::vector<Job> jobs_;                ///< two per patient
  std::vector<const Patient*> patient_;  ///< of each two jobs
  std::map<std::string, CaseOutcome> outcomes_;
  std::map<std::string, std::pair<double, double>> spent_;  ///< seconds and MB
};

void PatientRuns::begin(const Patient& p) {
  if (auto r = stillGood(options_.output, p, options_.reports)) {
    r->outcome.resumed = true;
    outcomes_[p.place.id] = r->outcome;
    return;
  }
  if (p.scene.empty()) {
    CaseRecord r = recordOf(p.place.id, p.key, "", "");
    r.outcome = {CaseOutcome::Status::Rejected, p.place.id, p.refused, false};
    writeWhole(resultOf(options_.output, p.place.id), toJson(r));
    outcomes_[p.place.id] = r.outcome;
    return;
  }
  const fs::path scene = work_.path() / (p.place.id + ".json");
  writeWhole(scene, options_.reports ? withReport(p.scene) : p.scene);
  const std::string threads = std::to_string(threadsEach(parallel_));
  Job measure{p.place.id + " measure",
              {"measure", "--mre", p.files.mre.string(), "--roi", p.files.roi.string(), "--mri", p.files.mri.string(),
               "--json", "--quiet", "--threads", threads}};
  measure.arguments.insert(measure.arguments.end(), p.files.meaning.begin(), p.files.meaning.end());
  jobs_.push_back(std::move(measure));
  jobs_.push_back({p.place.id,
                   {"run", scene.string(), "--output", (work_.path() / p.place.id).string(), "--json", "--quiet",
                    "--threads", threads}});
  patient_.push_back(&p);
}

void PatientRuns::keep(const Patient& p, JobOutcome& measured, JobOutcome& retracted) {
  CaseRecord r = recordOf(p.place.id, p.key, measured.exitCode == 0 ? measured.standardOutput : "",
                          retracted.exitCode == 0 ? retracted.standardOutput : "");
  for (std::string& w : r.warnings) w = detail::anonymous(w, p.place.folder, p.place.id);
  r.outcome = outcomeOf(p.place.id, retracted, p.place.folder);
  if (r.outcome.status == CaseOutcome::Status::Done && measured.exitCode != 0)
    r.warnings.push_back(detail::notMeasured + outcomeOf(p.place.id, measured, p.place.folder).reason);
  if (options_.reports) keepReport(work_.path() / p.place.id, reportOf(options_.output, p.place.id));
  writeWhole(resultOf(options_.output, p.place.id), toJson(r));
  outcomes_[p.place.id] = r.outcome;
  spent_[p.place.id] = {measured.seconds + retracted.seconds, std::max(measured.peak_MB, retracted.peak_MB)};
  measured = retracted = {};
  std::error_code ignored;
  fs::remove_all(work_.path() / p.place.id, ignored);
}

std::vector<CaseOutcome> PatientRuns::run(const Progress& progress) {
  for (const Patient& p : patients_) begin(p);
  std::vector<JobOutcome> ended(jobs_.size());
  std::vector<bool> there(jobs_.size(), false);
  runJobs(
      options_.executable, jobs_, parallel_,
      [&](std::size_t i, const JobOutcome& o) {
        ended[i] = o;
        there[i] = true;
        const std::size_t first = i - i % 2;
        if (there[first] && there[first + 1]) keep(*patient_[i / 2], ended[first], ended[first + 1]);
      },
      progress);
  if (!spent_.empty()) writeTimings(options_.output, spent_);
  std::vector<CaseOutcome> out;
  for (const Patient& p : patients_) out.push_back(outcomes_[p.place.id]);
  return out;
}

detail::Summary summarise(const CohortOptions& options, const std::set<std::string>& ids) {
  detail::Summary s;
  for (CaseRecord& r : readRecords(options.output))
    if (ids.count(r.outcome.id)) s.records.push_back(std::move(r));
  s.stiffness = stiffnessStudy(s.records, options.asPublished);
  s.retraction = retractionStudy(s.records);
  s.chosen = chooseCases(s.records);
  return s;
}

/// The chosen four, the figures and the report.
void finish(CohortResult& result, detail::Summary& summary, const std::map<std::string, std::string>& scenes,
            const CohortOptions& options, const Progress& progress) {
  for (const CaseRecord& r : summary.records)
    if (r.outcome.status == CaseOutcome::Status::Done && summary.sceneParameters.empty() && scenes.count(r.outcome.id))
      summary.sceneParameters = withoutPaths(scenes.at(r.outcome.id));
  detail::studyChosen(summary, scenes, options, progress);
  const std::vector<fs::path> files = detail::writeSummary(summary, options, result.json);
  result.files.insert(result.files.end(), files.begin(), files.end());
}

void checkOptions(const CohortOptions& options) {
  if (options.output.empty()) throw BadArgument("cohort: no output folder");
  if (options.shards < 1 || options.shard < 1 || options.shard > options.shards)
    throw BadInput("a shard is i/n with 1 ≤ i ≤ n, e.g. --shard 2/8");
}

}  // namespace

bool CohortResult::complete() const {
  return std::all_of(cases.begin(), cases.end(),
                     [](const CaseOutcome& c) { return c.status == CaseOutcome::Status::Done; });
}

CohortResult runCohort(const fs::path& folder, const CohortOptions& options, const Progress& progress) {
  checkOptions(options);
  const std::vector<PatientFolder> all = findPatients(folder);
  const std::optional<std::string> sceneTemplate = templateText(options);
  std::vector<Patient> patients;
  for (const PatientFolder& place : all) {
    if ((place.number - 1) % options.shards != options.shard - 1) continue;
    progress.report(0.05 * place.number / static_cast<double>(all.size()), "reading " + place.id);
    patients.push_back(asAsked(readPatient(place, sceneTemplate), sceneTemplate, options));
  }
  CohortResult result;
  const bool whole = options.shards == 1;
  result.cases = PatientRuns(patients, options).run(progress.part(0.05, whole ? 0.8 : 1.0));
  for (const CaseOutcome& c : result.cases) result.files.push_back(resultOf(options.output, c.id));
  // What a shard must be put together with.
  writeWhole(options.output / "shard.json", Json({{"schema", "glisson/cohort-shard/1"},
                                                  {"shard", options.shard},
                                                  {"shards", options.shards},
                                                  {"patients", all.size()}})
                                                    .dump(1) +
                                                "\n");
  if (!whole) return result;
  std::set<std::string> ids;
  std::map<std::string, std::string> scenes;
  for (const Patient& p : patients) {
    ids.insert(p.place.id);
    if (!p.scene.empty()) scenes[p.place.id] = p.scene;
  }
  detail::Summary summary = summarise(options, ids);
  finish(result, summary, scenes, options, progress.part(0.8, 1.0));
  return result;
}

bool isMadeOf(const std::string& key, const PatientFolder& patient) {
  const Patient read = readPatient(patient, {});
  CohortOptions options;
  for (const bool reports : {false, true})
    for (const bool uncertainty : {false, true}) {
      options.reports = reports;
      options.uncertainty = uncertainty;
      if (asAsked(read, {}, options).key == key) return true;
    }
  return false;
}

CohortResult mergeCohort(const std::vector<fs::path>& shards, const fs::path& folder, const CohortOptions& options,
                         const Progress& progress) {
  checkOptions(options);
  std::set<int> seen;
  std::size_t expected = 0, patients = 0;
  std::set<std::string> ids;
  for (const fs::path& shard : shards) {
    const Json j = Json::parse(readWhole(shard / "shard.json"), nullptr, false);
    if (!j.is_object() || j.value("schema", "") != "glisson/cohort-shard/1")
      throw BadInput("'" + shard.filename().string() +
                     "' holds no finished shard; run cohort --shard i/n into it first");
    if (expected != 0 && (expected != j["shards"] || patients != j["patients"]))
      throw BadInput("the shards are of different cohorts: they disagree on the number of shards or patients");
    expected = j["shards"];
    patients = j["patients"];
    seen.insert(j["shard"].get<int>());
    for (const CaseRecord& r : readRecords(shard)) {
      const std::string text = readWhole(resultOf(shard, r.outcome.id));
      const fs::path target = resultOf(options.output, r.outcome.id);
      if (ids.count(r.outcome.id) && readWhole(target) != text)
        throw BadInput("two shards hold different results for " + r.outcome.id + "; run one of them again");
      writeWhole(target, text);
      keepReport(reportOf(shard, r.outcome.id), reportOf(options.output, r.outcome.id));
      ids.insert(r.outcome.id);
    }
  }
  if (seen.size() != expected || ids.size() != patients)
    throw BadInput("shards are missing: " + std::to_string(seen.size()) + " of " + std::to_string(expected) +
                   " were given, with " + std::to_string(ids.size()) + " of " + std::to_string(patients) + " patients");
  writeWhole(
      options.output / "shard.json",
      Json({{"schema", "glisson/cohort-shard/1"}, {"shard", 1}, {"shards", 1}, {"patients", patients}}).dump(1) + "\n");
  CohortResult result;
  detail::Summary summary = summarise(options, ids);
  for (const CaseRecord& r : summary.records) {
    result.cases.push_back(r.outcome);
    result.files.push_back(resultOf(options.output, r.outcome.id));
  }
  std::map<std::string, std::string> scenes;
  if (!folder.empty()) {
    const std::optional<std::string> sceneTemplate = templateText(options);
    for (const PatientFolder& place : findPatients(folder)) {
      const bool chosen =
          std::any_of(summary.chosen.begin(), summary.chosen.end(), [&](const Chosen& c) { return c.id == place.id; });
      const auto first = std::find_if(summary.records.begin(), summary.records.end(), [](const CaseRecord& r) {
        return r.outcome.status == CaseOutcome::Status::Done;
      });
      if (chosen || (first != summary.records.end() && first->outcome.id == place.id))
        scenes[place.id] = sceneOf(place.folder, sceneTemplate);
    }
  }
  finish(result, summary, scenes, options, progress);
  return result;
}

}  // namespace glisson::cohort
