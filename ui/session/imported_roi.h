#pragma once

#include <QString>

#include "dicom/series.h"
#include "pipeline/sources.h"

namespace glisson::session {

/// Whether outlines from a file may be used with the images that are open (pipeline::checkRoi). Throws BadInput where
/// they are of another patient or day; gives what the user is to be told about them, empty where there is nothing.
inline QString belongs(const pipeline::LoadedRoi& roi, const dicom::Series& mri) {
  pipeline::AnatomicalImage image;
  image.frameOfReferenceUid = mri.frameOfReferenceUid;
  image.patientKey = mri.patientKey;
  image.studyDate = mri.studyDate;
  image.studyUid = mri.studyUid;
  QString text;
  std::vector<std::string> said = pipeline::checkRoi(roi, &image, nullptr, false);
  said.insert(said.end(), roi.warnings.begin(), roi.warnings.end());
  for (const std::string& one : said) text += (text.isEmpty() ? "" : "; ") + QString::fromStdString(one);
  return text;
}

}  // namespace glisson::session
