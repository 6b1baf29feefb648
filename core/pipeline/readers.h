// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "elastography/bootstrap.h"
#include "elastography/readers.h"
#include "pipeline/sources.h"
#include "roi/agreement.h"

namespace glisson::pipeline {

/// Outlines of several readers, and what to compare them on.
struct ReaderRequest {
  std::vector<std::filesystem::path> readers;  ///< at least two: a region each, or a folder each with one file per case
  std::filesystem::path mri;                   ///< image, or folder of images, that outlines were drawn on
  std::filesystem::path mre;                   ///< elastogram, or folder of elastograms; empty: outlines only
  MapMeaning meaning;                          ///< of bare maps
  int label = 0;                               ///< of masks
  std::string name;                            ///< of structures
  bool overrideChecks = false;                 ///< outlines of other patients or days are meant
  bool outlines = false;                       ///< distances in each slice (few, thick slices) instead of in space
};

/// How sure the agreement of a reader with the first is: bootstrap over slices.
struct ReaderIntervals {
  std::size_t slices = 0;  ///< that either reader has outlined
  elastography::Interval dice, jaccard, volumeDifference_mL, volumeDifference_percent;
  std::optional<elastography::Interval> stiffnessDifference_kPa;  ///< with an elastogram
};

/// What all readers say of one case.
struct ReadersOfCase {
  std::string name;                                       ///< of the files, without extension
  std::vector<double> volume_mL;                          ///< of each reader
  std::vector<double> stiffness_kPa;                      ///< mean of each reader; empty without an elastogram
  std::vector<elastography::Interval> stiffnessMean_kPa;  ///< the same means with their intervals
  std::vector<roi::Agreement> agreement;                  ///< of each further reader with the first
  std::vector<ReaderIntervals> intervals;                 ///< of each agreement
};

/// Readers compared over all cases.
struct ReaderStudy {
  std::vector<ReadersOfCase> cases;
  /// Over cases, where there are enough (reliability: 2, limits of agreement: 3); limits: second against first reader.
  std::optional<elastography::ReaderReliability> volume, stiffness;
  std::optional<elastography::BlandAltman> volumeLimits, stiffnessLimits;
  std::vector<std::string> warnings;
};

/// Folders are matched by file name without extension; what not all readers have is named in warnings. The grid is that
/// of the first mask among the readers, else of the MRI, else of the elastogram. Throws BadInput where there is none.
ReaderStudy compareReaders(const ReaderRequest& request, const Progress& progress = {});

/// readers.csv (case, reader, quantity, value, unit), and a Bland-Altman chart (PNG and SVG) of each quantity that has
/// limits. Returns the files.
std::vector<std::filesystem::path> writeReaders(const std::filesystem::path& folder, const ReaderStudy& study);

}  // namespace glisson::pipeline
