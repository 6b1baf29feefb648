// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// The products of one elastography acquisition, as indices into ScanResult::series; -1 where there is none.
struct Acquisition {
  int magnitude = -1, stiffness = -1, confidence = -1;
  std::vector<int> wave;            ///< every volume of the wave images, in order of the list
  std::vector<int> otherStiffness;  ///< masked copies and the like
  std::string why;                  ///< what ties them together, in words
  Diagnostics diagnostics;          ///< what is doubtful about it
};

/// What belongs to the stiffness series at that place: by what the files say, strongest first: one series, references
/// to each other, AcquisitionUID, the vendor's numbering of series, AcquisitionNumber, frame of reference, time,
/// geometry; and the order of series numbers where nothing else is known, which is told. A series set by hand goes
/// first. What belongs to another acquisition, or fits no better than its like, is not taken, and told.
Acquisition partnersOf(const ScanResult& scan, int stiffness);

/// Every acquisition of the scan, in order of its stiffness series; then what is left without one.
std::vector<Acquisition> acquisitions(const ScanResult& scan);

}  // namespace glisson::dicom
