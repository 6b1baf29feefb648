// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/cohort_table.h"

#include <QtGlobal>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/quantity.h"
#include "base/text.h"
#include "cohort/patients.h"
#include "pipeline/case_folder.h"
#include "pipeline/scene.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;
using cohort::CaseOutcome;
using cohort::CaseRecord;
using Json = nlohmann::ordered_json;

/// Where the record of a run may lie below a folder.
constexpr const char* recordPlaces[] = {"run.json", "results/run.json", "last-run/results/run.json", "report/run.json"};

fs::path recordBelow(const fs::path& folder) {
  std::error_code ignored;
  for (const char* place : recordPlaces)
    if (fs::is_regular_file(folder / place, ignored)) return folder / place;
  return {};
}

/// The stiffness of a run, as `measure` would have said it.
std::string measureOf(const Json& run) {
  if (!run.contains("stiffness") || !run["stiffness"].is_object()) return {};
  const Json& s = run["stiffness"];
  const bool shear = s.value("quantity", "shear") == "shear";
  const double mean = s.value("mean_kPa", std::numeric_limits<double>::quiet_NaN());
  return Json{{"quantity", shear ? "shear" : "youngs"},
              {"pooled", {{"mean_kPa", mean}, {"sd_kPa", s.value("sd_kPa", 0.0)}, {"n", s.value("n", 0LL)}}},
              {"youngs_mean_kPa", shear ? 3.0 * mean : mean}}
      .dump();
}

/// What shows the patient of a run: its case, else the images that its scene names.
fs::path opensRun(const fs::path& folder, const fs::path& record) {
  std::error_code ignored;
  if (pipeline::isCase(folder)) return folder / "case.json";
  const fs::path scene = record.parent_path() / "scene.json";
  if (!fs::is_regular_file(scene, ignored)) return {};
  try {
    const fs::path mri = pipeline::readScene(scene).geometry.mri;
    return fs::exists(mri, ignored) ? mri : fs::path();
  } catch (const Error&) {
    return {};  // the table shows its figures all the same
  }
}

std::optional<CohortPatient> patientOfRun(const cohort::PatientFolder& place) {
  const fs::path record = recordBelow(place.folder);
  if (record.empty()) return {};
  const std::string text = cohort::readWhole(record);
  const Json run = Json::parse(text, nullptr, false);
  CohortPatient patient;
  try {
    if (!run.is_object() || run.value("schema", "") != "glisson/run/1") return {};
    patient.record = cohort::recordOf(place.id, {}, measureOf(run), text);
    const bool converged = !run.contains("solver") || run["solver"].value("converged", true);
    patient.record.outcome.status = converged ? CaseOutcome::Status::Done : CaseOutcome::Status::Failed;
    if (!converged) patient.record.outcome.reason = "the solve did not converge";
  } catch (const Json::exception&) {
    return {};  // the record of another version, or damaged
  }
  patient.opens = opensRun(place.folder, record);
  return patient;
}

Cohort readResults(const fs::path& cases, const Progress& progress) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(cases))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  Cohort read;
  for (std::size_t n = 0; n < folders.size(); ++n) {
    progress.report(static_cast<double>(n) / static_cast<double>(folders.size()), "reading files");
    const fs::path file = folders[n] / "result.json";
    std::optional<CaseRecord> record;
    if (fs::is_regular_file(file)) record = cohort::parseRecord(cohort::readWhole(file));
    if (record)
      read.patients.push_back({std::move(*record), {}});
    else
      ++read.unread;
  }
  return read;
}

Cohort readRuns(const fs::path& folder, const Progress& progress) {
  Cohort read;
  read.kind = Cohort::Kind::Runs;
  const std::vector<cohort::PatientFolder> places = cohort::findPatients(folder);
  for (std::size_t n = 0; n < places.size(); ++n) {
    progress.report(static_cast<double>(n) / static_cast<double>(places.size()), "reading files");
    if (auto patient = patientOfRun(places[n]))
      read.patients.push_back(std::move(*patient));
    else
      ++read.unread;
  }
  return read;
}

const char* wordOf(CaseOutcome::Status status) {
  return status == CaseOutcome::Status::Done ? "done" : status == CaseOutcome::Status::Failed ? "failed" : "rejected";
}

}  // namespace

const std::vector<CohortFigure>& cohortFigures() {
  using R = CaseRecord;
  const double voxel = defaults::mriVoxel.mm(), significant = defaults::clinicallySignificant.mm();
  static const char* const voxelWords = QT_TRANSLATE_NOOP("cohort", "one MRI voxel");
  static const char* const significantWords = QT_TRANSLATE_NOOP("cohort", "clinically significant");
  static const std::vector<CohortFigure> figures = {
      {QT_TRANSLATE_NOOP("cohort", "Difference at the retractor"),
       "mm",
       &R::at_retractor_mm,
       2,
       0.5,
       {significant, significantWords}},
      {QT_TRANSLATE_NOOP("cohort", "Error of that by the cells"), "mm", &R::difference_error_mm, 2, 0.1, {}},
      {QT_TRANSLATE_NOOP("cohort", "Mean difference"), "mm", &R::mean_mm, 2, 0.5, {voxel, voxelWords}},
      {QT_TRANSLATE_NOOP("cohort", "95 % of the liver within"),
       "mm",
       &R::p95_mm,
       2,
       0.5,
       {significant, significantWords}},
      {QT_TRANSLATE_NOOP("cohort", "Largest difference"), "mm", &R::max_mm, 2, 1.0, {significant, significantWords}},
      {QT_TRANSLATE_NOOP("cohort", "Mean difference of vessels"),
       "mm",
       &R::vessel_mean_mm,
       2,
       0.5,
       {voxel, voxelWords}},
      {QT_TRANSLATE_NOOP("cohort", "Shear modulus µ"),
       "kPa",
       &R::shear_kPa,
       2,
       0.5,
       {2.1, QT_TRANSLATE_NOOP("cohort", "textbook")}},
      {QT_TRANSLATE_NOOP("cohort", "SD of µ"), "kPa", &R::sd_kPa, 2, 0.1, {}},
      {QT_TRANSLATE_NOOP("cohort", "Volume"), "mL", &R::volume_mL, 0, 100.0, {}},
      {QT_TRANSLATE_NOOP("cohort", "Travel of the bar"), "mm", &R::travel_mm, 1, 2.0, {}},
      {QT_TRANSLATE_NOOP("cohort", "Travel, measured less atlas"), "mm", &R::travel_difference_mm, 1, 1.0, {}},
      {QT_TRANSLATE_NOOP("cohort", "Strain, 95 % below"), "", &R::p95_strain, 3, 0.02, {}},
      {QT_TRANSLATE_NOOP("cohort", "Largest rotation"), "°", &R::rotation_deg, 1, 2.0, {}},
  };
  return figures;
}

Cohort readCohort(const fs::path& folder, const Progress& progress) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) throw BadInput("there is no such folder");
  const fs::path cases = fs::is_directory(folder / "cases", failed) ? folder / "cases"
                         : folder.filename() == "cases"             ? folder
                                                                    : fs::path();
  Cohort read = cases.empty() ? readRuns(folder, progress) : readResults(cases, progress);
  if (read.patients.empty())
    throw BadInput(
        "the folder holds neither results of a cohort (cases/…/result.json) nor folders of runs or saved cases "
        "(run.json, last-run)");
  progress.report(1.0, "done");
  return read;
}

FoundPatient patientOf(const CaseRecord& record, const fs::path& patients, const Progress& progress) {
  progress.report(0.0, "reading files");
  for (const cohort::PatientFolder& place : cohort::findPatients(patients)) {
    if (place.id != record.outcome.id) continue;
    const bool certain = cohort::isMadeOf(record.key, place);
    progress.check();
    std::error_code ignored;
    return {fs::is_regular_file(place.folder / "case.json", ignored) ? place.folder / "case.json" : place.folder,
            certain};
  }
  throw BadInput("the folder of patients holds no " + record.outcome.id +
                 "; choose the one that the cohort was run over");
}

bool CohortFilter::passes(const CohortPatient& patient) const {
  const CaseRecord& r = patient.record;
  if (figure != nullptr && (std::isfinite(low) || std::isfinite(high))) {
    const double v = r.*figure->value;
    if (!(v >= low && v <= high)) return false;
  }
  if (text.empty()) return true;
  std::string all = r.outcome.id + " " + wordOf(r.outcome.status) + " " + r.outcome.reason + " " + r.kinematics;
  for (const std::string& w : r.warnings) all += " " + w;
  return lowerCase(all).find(lowerCase(text)) != std::string::npos;
}

std::vector<std::size_t> passing(const Cohort& cohort, const CohortFilter& filter) {
  std::vector<std::size_t> which;
  for (std::size_t n = 0; n < cohort.patients.size(); ++n)
    if (filter.passes(cohort.patients[n])) which.push_back(n);
  return which;
}

std::vector<double> valuesOf(const Cohort& cohort, const std::vector<std::size_t>& which, const CohortFigure& figure) {
  std::vector<double> values;
  for (const std::size_t n : which)
    if (const double v = cohort.patients[n].record.*figure.value; std::isfinite(v)) values.push_back(v);
  return values;
}

std::vector<std::size_t> within(const Cohort& cohort, const std::vector<std::size_t>& which, const CohortFigure& figure,
                                double low, double high) {
  std::vector<std::size_t> found;
  for (const std::size_t n : which)
    if (const double v = cohort.patients[n].record.*figure.value; v >= low && v < high) found.push_back(n);
  return found;
}

std::optional<std::size_t> nearest(const Cohort& cohort, const std::vector<std::size_t>& which,
                                   const CohortFigure& figure, double value) {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t n : which) {
    const double apart = std::abs(cohort.patients[n].record.*figure.value - value);
    if (!(apart < least)) continue;
    least = apart;
    best = n;
  }
  return best;
}

}  // namespace glisson::session
