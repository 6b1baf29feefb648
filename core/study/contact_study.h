// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "study/rows.h"

namespace glisson::study {

/// The names of the references, as in Row::reference.
inline constexpr const char* hertz = "Hertz, line contact";
inline constexpr const char* calculix = "CalculiX 2.20, C3D20R, rigid cylinder";
inline constexpr const char* elastica = "Euler's elastica";

/// Extent of the contact study.
struct ContactStudyOptions {
  bool quick = false;  ///< the coarser resolutions only
};

/// Contact and large deformation against known answers, error against run time.
struct ContactStudy {
  /// Hertz (a rigid cylinder of 5 mm radius on a half plane, contact half width 1 mm): max_error_mm of the half width
  /// by the second moment of pressure, tip_error_mm by the largest pressure. CalculiX (10 × 80 mm bar with 4.6 N on a
  /// block of 160 × 60 × 100 mm): largest error of the depths under the bar, 20 and 40 mm below; tip: under the bar.
  /// Elastica (cantilever 100 × 5 × 5 mm, dead end force P L² / E I = 4): distance of the tip; tip: its height.
  std::vector<Row> rows;
  std::string summary() const;  ///< the references, in lines
};

/// Two neo-Hookean laws, several resolutions each. About a minute on two cores. Throws Cancelled.
ContactStudy studyContact(const ContactStudyOptions& options, const Progress& progress = {});

/// Tip of Euler's elastica, an inextensible cantilever under a dead force at its end across its rest: how far along and
/// across, over its length. load: P L² / (E I), at most 20. Shooting with the classical Runge-Kutta method, exact to
/// 1e-8.
struct ElasticaTip {
  double along = 1.0, across = 0.0;
};
ElasticaTip elasticaTip(double load);

/// Writes validate-contact.csv and a chart for each reference; returns the files. Throws BadInput.
std::vector<std::filesystem::path> writeContactStudy(const std::filesystem::path& folder, const ContactStudy& study);

}  // namespace glisson::study
