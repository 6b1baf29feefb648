// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "dicom/series.h"
#include "pipeline/sources.h"
#include "session/said.h"
#include "session/session.h"

namespace glisson::session {

/// Why outlines from a file are not of the images that are open.
struct Belonging {
  QString refusal;  ///< of another patient or day
  QString doubt;    ///< of another frame of reference: to be confirmed
  QString notes;    ///< what else is to be told
};

inline Belonging belongs(const pipeline::LoadedRoi& roi, const dicom::Series& mri) {
  pipeline::AnatomicalImage image;
  image.frameOfReferenceUid = mri.frameOfReferenceUid;
  image.patientKey = mri.patientKey;
  image.studyDate = mri.studyDate;
  image.studyUid = mri.studyUid;
  Belonging b;
  using In = pipeline::Difference::In;
  for (const pipeline::Difference& d : pipeline::differences(roi, &image, nullptr)) {
    if (d.in == In::Patient)
      b.refusal = Session::tr("These outlines belong to another patient than the images that are open.");
    else if (d.in == In::Day && b.refusal.isEmpty())
      b.refusal = Session::tr(
          "These outlines were drawn on images of another day than those that are open. Open these images, or choose "
          "outlines that were drawn on the open ones.");
    else if (d.in == In::Frame)
      b.doubt = Session::tr(
          "These outlines have another frame of reference than the MRI: they may lie elsewhere in the patient.");
  }
  b.notes = said(roi.warnings, roi.diagnostics).join(QStringLiteral("; "));
  return b;
}

}  // namespace glisson::session
