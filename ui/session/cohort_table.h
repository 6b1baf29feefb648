// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cohort/records.h"
#include "render/charts.h"

namespace glisson::session {

/// A figure of a patient, as table and charts show it.
struct CohortFigure {
  const char* words;  ///< translated in the context "cohort"
  const char* unit;   ///< empty: a share, or none
  double cohort::CaseRecord::*value;
  int decimals;
  double binWidth;  ///< of its histogram
  struct Line {
    double value = std::numeric_limits<double>::quiet_NaN();
    const char* words = nullptr;  ///< null: no line
  } line;
};
/// In the order of the table.
const std::vector<CohortFigure>& cohortFigures();

struct CohortPatient {
  cohort::CaseRecord record;    ///< id: "case-001"; nobody is named
  std::filesystem::path opens;  ///< what shows this patient; empty where that is not known yet
};

struct Cohort {
  /// What the folder holds: results of `glisson-cli cohort`, which know no patient's place, or runs and saved cases.
  enum class Kind { Results, Runs } kind = Kind::Results;
  std::vector<CohortPatient> patients;  ///< by id
  std::size_t unread = 0;               ///< folders that hold nothing of that kind, or nothing whole
};

/// Reads the output folder of a cohort, or a folder with one folder per run or saved case. Throws BadInput where it
/// holds neither; Cancelled.
Cohort readCohort(const std::filesystem::path& folder, const Progress& progress = {});

/// The folder of this patient among those a cohort was run over. Whether it holds what the result was made of is found
/// by its key, which reads all of its files.
struct FoundPatient {
  std::filesystem::path folder;
  bool certain = false;  ///< else: other files, another version, or a template scene
};
/// Throws BadInput where there is no such patient.
FoundPatient patientOf(const cohort::CaseRecord& record, const std::filesystem::path& patients,
                       const Progress& progress = {});

/// Which patients are shown.
struct CohortFilter {
  std::string text;                                       ///< in id, status, reason or warnings; any case
  const CohortFigure* figure = nullptr;                   ///< with the ends below
  double low = -std::numeric_limits<double>::infinity();  ///< inclusive
  double high = std::numeric_limits<double>::infinity();  ///< inclusive
  bool passes(const CohortPatient& patient) const;
};
/// Indices into cohort.patients.
std::vector<std::size_t> passing(const Cohort& cohort, const CohortFilter& filter);

/// Values of these patients, finite ones.
std::vector<double> valuesOf(const Cohort& cohort, const std::vector<std::size_t>& which, const CohortFigure& figure);
/// Of these patients those whose figure is in [low, high).
std::vector<std::size_t> within(const Cohort& cohort, const std::vector<std::size_t>& which, const CohortFigure& figure,
                                double low, double high);
/// Of these patients the one whose figure is nearest; nothing where none has it.
std::optional<std::size_t> nearest(const Cohort& cohort, const std::vector<std::size_t>& which,
                                   const CohortFigure& figure, double value);

}  // namespace glisson::session
