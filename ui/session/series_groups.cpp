// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/series_groups.h"

#include <algorithm>
#include <map>

namespace glisson::session {

namespace {

std::string withDashes(const std::string& date) {
  const bool digits =
      date.size() == 8 && std::all_of(date.begin(), date.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? date.substr(0, 4) + '-' + date.substr(4, 2) + '-' + date.substr(6) : date;
}

}  // namespace

std::vector<PatientGroup> groupsOf(const dicom::ScanResult& scan) {
  std::vector<PatientGroup> patients;
  PatientGroup nameless;
  std::map<std::string, std::size_t> patientOf;
  std::map<std::pair<std::string, std::string>, std::size_t> studyOf;
  for (std::size_t i = 0; i < scan.series.size(); ++i) {
    const dicom::Series& s = scan.series[i];
    PatientGroup* patient = &nameless;
    if (!s.patientKey.empty()) {
      const auto [found, isNew] = patientOf.try_emplace(s.patientKey, patients.size());
      if (isNew) patients.push_back({static_cast<int>(patients.size()) + 1, {}});
      patient = &patients[found->second];
    }
    const auto [found, isNew] =
        studyOf.try_emplace({s.patientKey, s.studyUid.empty() ? s.studyDate : s.studyUid}, patient->studies.size());
    if (isNew) patient->studies.push_back({withDashes(s.studyDate), s.modality, {}});
    StudyGroup& study = patient->studies[found->second];
    study.series.push_back(static_cast<int>(i));
    if (study.modalities.find(s.modality) == std::string::npos) study.modalities += ", " + s.modality;
  }
  if (!nameless.studies.empty()) patients.push_back(std::move(nameless));
  for (PatientGroup& p : patients)
    std::stable_sort(p.studies.begin(), p.studies.end(),
                     [](const StudyGroup& a, const StudyGroup& b) { return a.date < b.date; });
  return patients;
}

}  // namespace glisson::session
