// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"

namespace glisson::cohort {

struct PatientFolder;

/// What a cohort's run does, and with what.
struct CohortOptions {
  std::filesystem::path output;                ///< results; what is there already and still holds is not computed again
  std::filesystem::path executable;            ///< glisson-cli, which runs each patient in a process of its own
  std::optional<std::filesystem::path> scene;  ///< template: everything but the geometry; empty: the patient's own
                                               ///< scene.json, or the paper's retraction where it has none
  int jobs = 0;                                ///< patients at a time; 0 = as many as cores and memory allow
  int shard = 1, shards = 1;  ///< only patients number n with n ≡ shard (mod shards); no summary where shards > 1
  bool asPublished = false;   ///< histogram of Young's moduli against 2.1 kPa, as the paper draws it
  bool uncertainty = false;   ///< says of every patient how sure it is, which intervals on the shares come from
  bool reports = false;       ///< a report of every patient, beside its numbers: 15 s of processor time each
  bool sensitivity = true;    ///< runs the chosen four again under the assumptions that the paper leaves open
};

/// What became of one patient. Patients go by number: "case-001" is the first folder by name.
struct CaseOutcome {
  enum class Status { Done, Rejected, Failed } status = Status::Failed;
  std::string id;
  std::string reason;  ///< one sentence, empty where Done; holds no name and no path
  bool resumed = false;
};

/// What a cohort's run has done.
struct CohortResult {
  std::vector<CaseOutcome> cases;
  std::vector<std::filesystem::path> files;
  std::string json;  ///< cohort.json: the three studies' numbers; empty for a shard
  bool complete() const;
};

/// Runs the paper's studies 1 and 2 over a folder that holds one folder per patient: measures each stiffness, retracts
/// each liver with MRE and with atlas stiffness, and summarises. Writes
///   cases/<id>/result.json     numbers of one patient; the same bytes on any machine and in any order
///   cases/<id>/report/         with reports: report.html, report.pdf, run.json ("replay" takes it)
///   timings.csv                time and memory per patient (the one file that differs from run to run)
///   cohort.json, patients.csv, rejected.csv, report.html, figures as PNG and SVG   (summarise)
/// Where it was stopped at any point, another call goes on. Throws BadInput (no patients), Cancelled.
CohortResult runCohort(const std::filesystem::path& patients, const CohortOptions& options,
                       const Progress& progress = {});

/// Whether a result of runCohort, by its key, was made of exactly the files that this patient's folder holds, with this
/// version and without a template scene. Reads all of them.
bool isMadeOf(const std::string& key, const PatientFolder& patient);

/// Puts the results of shards together and summarises them: the bytes that one machine would have written. patients:
/// the same folder again, for the overlays and the sensitivity of the chosen four; empty leaves those out.
/// Throws BadInput where two shards hold the same patient with different results, or shards are missing.
CohortResult mergeCohort(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& patients,
                         const CohortOptions& options, const Progress& progress = {});

}  // namespace glisson::cohort
