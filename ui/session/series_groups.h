// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "dicom/series.h"

namespace glisson::session {

/// Series of one examination.
struct StudyGroup {
  std::string date;         ///< "2024-03-05", or as the files have it; empty where they name none
  std::string modalities;   ///< "MR", "CT, MR"; empty for volume files
  std::vector<int> series;  ///< indices into ScanResult::series, in its order
};

/// Examinations of one patient.
struct PatientGroup {
  int number = 0;  ///< from 1, in order of appearance; 0: files that name no patient (volume files)
  std::vector<StudyGroup> studies;
};

/// Patient, study, series: each in order of the date of the study, then of appearance. Studies are told apart by UID,
/// where they have none by date. Files that name no patient come last, as one group.
std::vector<PatientGroup> groupsOf(const dicom::ScanResult& scan);

}  // namespace glisson::session
