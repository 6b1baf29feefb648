// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/private_folder.h"
#include "base/progress.h"
#include "cohort/patients.h"
#include "cohort/records.h"
#include "cohort/statistics.h"

namespace glisson::cohort::detail {

/// Begins the warning of a patient that was retracted without a mean stiffness; the reason follows.
inline const std::string notMeasured = "the mean stiffness was not measured: ";

/// One assumption changed, on one patient.
struct Variation {
  std::string name;   ///< "abdomen half as stiff", ...; "as simulated" is the baseline
  std::string scene;  ///< scene JSON
};
/// The baseline and every assumption that the paper leaves open, one at a time.
std::vector<Variation> variations(const std::string& sceneJson);

/// What a variation gave on one of the chosen patients; NaN where it did not come to an end.
struct SensitivityRow {
  std::string variation, id;
  double mean_mm = 0.0, at_retractor_mm = 0.0;
};

/// How many pictures the report shows of each chosen patient.
inline constexpr std::size_t shownPictures = 3;

/// Everything that the summary shows.
struct Summary {
  std::vector<CaseRecord> records;
  StiffnessStudy stiffness;
  RetractionStudy retraction;
  std::vector<Chosen> chosen;
  std::vector<SensitivityRow> sensitivity;
  std::map<std::string, std::vector<std::filesystem::path>> pictures;  ///< per chosen patient
  std::map<std::string, std::string> pictureNotes;  ///< why a chosen patient has none; absent where all were drawn
  std::string sceneParameters;                      ///< scene JSON without paths, of the first patient that is left
};

/// Runs the chosen patients again, with pictures and with every variation, where that is not done yet.
/// scenes: scene JSON per id. Fills sensitivity and pictures.
void studyChosen(Summary& summary, const std::map<std::string, std::string>& scenes, const CohortOptions& options,
                 const Progress& progress);

/// Writes figures, tables, cohort.json and report.html; returns the files and sets json.
std::vector<std::filesystem::path> writeSummary(const Summary& summary, const CohortOptions& options,
                                                std::string& json);

/// A command's last message without the program's name, the patient's folder and its name, and without names in
/// quotation marks: of files, structures, segments and series, which are often made of the patient's.
std::string anonymous(std::string message, const std::filesystem::path& folder, const std::string& id);

}  // namespace glisson::cohort::detail
