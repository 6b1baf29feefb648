// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace glisson::dicom {

/// Whose an object is and of which examination: to compare, never to show. Empty where the object does not say.
struct Origin {
  std::string patientKey;  ///< SHA-256 of the patient's identity
  std::string studyUid;
  std::string studyDate;
};

}  // namespace glisson::dicom
