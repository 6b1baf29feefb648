// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cohort/records.h"

namespace glisson::cohort {

/// Mean, standard deviation (n − 1) and order statistics of finite values; NaN where there are none.
struct Spread {
  std::size_t n = 0;
  double mean = 0.0, sd = 0.0, median = 0.0, min = 0.0, max = 0.0;
};
Spread spreadOf(const std::vector<double>& values);

/// Study 1: stiffness over the cohort against the textbook value.
struct StiffnessStudy {
  bool asPublished = false;  ///< Young's modulus against 2.1 kPa; else shear modulus against 2.1 kPa
  double atlas_kPa = 2.1;
  std::vector<double> values_kPa;  ///< one per measured patient
  Spread spread;
  double fractionOver1kPa = 0.0;   ///< of patients more than 1 kPa above the atlas
  double fractionOverTwice = 0.0;  ///< of patients more than twice the atlas
};
StiffnessStudy stiffnessStudy(const std::vector<CaseRecord>& records, bool asPublished);

/// A share of the patients, from the probability of each: the patients as independent, their 95 % interval from the
/// exact distribution of the count. It is about these patients, not about all that could have been taken.
struct SureShare {
  std::size_t n = 0;  ///< patients whose run says how sure it is
  double expected = 0.0, low = 0.0, high = 0.0;
};
/// Nothing where no probability is finite.
std::optional<SureShare> sureShareOf(const std::vector<double>& probabilities);

/// Study 2: where the two retractions place the liver.
struct RetractionStudy {
  std::size_t tried = 0, rejected = 0, failed = 0, left = 0;
  std::vector<double> mean_mm, at_retractor_mm;  ///< one per patient that is left
  std::vector<double> travel_mm;                 ///< |difference| of the bar's travel, of those with a rigid bar
  Spread mean, atRetractor, travel;
  double fractionWithinVoxel = 0.0;        ///< mean difference at most 1.64 mm
  double fractionSignificant = 0.0;        ///< at the retractor at least 5 mm
  double fractionTravelSignificant = 0.0;  ///< the bar's travel differs by at least 5 mm
  /// The same three shares of the patients that say how sure they are.
  std::optional<SureShare> sureWithinVoxel, sureSignificant, sureTravelSignificant;
};
RetractionStudy retractionStudy(const std::vector<CaseRecord>& records);

/// One of the four patients that are shown: the one nearest to the mean of the difference at the retractor, to one and
/// to two standard deviations above it, and the one furthest above; each another patient. Fewer where there are fewer.
/// Patients whose two predictions can both be drawn come first: a picture is what they are chosen for.
struct Chosen {
  std::string what;  ///< "mean", "+1 SD", "+2 SD", "outlier"
  std::string id;
  double at_retractor_mm = 0.0;
  std::size_t passedOver = 0;  ///< patients nearer to what was looked for that cannot be drawn
};
std::vector<Chosen> chooseCases(const std::vector<CaseRecord>& records);

}  // namespace glisson::cohort
