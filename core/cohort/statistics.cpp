// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.h"

namespace glisson::cohort {

Spread spreadOf(const std::vector<double>& values) {
  std::vector<double> v;
  for (const double x : values)
    if (std::isfinite(x)) v.push_back(x);
  std::sort(v.begin(), v.end());
  Spread s;
  s.n = v.size();
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (v.empty()) return {0, none, none, none, none, none};
  for (const double x : v) s.mean += x / static_cast<double>(v.size());
  double squares = 0.0;
  for (const double x : v) squares += (x - s.mean) * (x - s.mean);
  s.sd = v.size() > 1 ? std::sqrt(squares / static_cast<double>(v.size() - 1)) : 0.0;
  s.median = 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
  s.min = v.front();
  s.max = v.back();
  return s;
}

StiffnessStudy stiffnessStudy(const std::vector<CaseRecord>& records, bool asPublished) {
  StiffnessStudy s;
  s.asPublished = asPublished;
  s.atlas_kPa = defaults::atlasShear.kPa();
  std::size_t over1 = 0, twice = 0;
  for (const CaseRecord& r : records) {
    if (!r.measured()) continue;
    const double v = asPublished ? r.youngs_kPa : r.shear_kPa;
    s.values_kPa.push_back(v);
    if (v > s.atlas_kPa + 1.0) ++over1;
    if (v > 2.0 * s.atlas_kPa) ++twice;
  }
  s.spread = spreadOf(s.values_kPa);
  if (!s.values_kPa.empty()) {
    s.fractionOver1kPa = static_cast<double>(over1) / static_cast<double>(s.values_kPa.size());
    s.fractionOverTwice = static_cast<double>(twice) / static_cast<double>(s.values_kPa.size());
  }
  return s;
}

std::optional<SureShare> sureShareOf(const std::vector<double>& probabilities) {
  SureShare s;
  std::vector<double> ofCount = {1.0};  // probability that so many of the patients seen are in
  for (const double p : probabilities) {
    if (!std::isfinite(p)) continue;
    ++s.n;
    s.expected += p;
    ofCount.push_back(0.0);
    for (std::size_t k = ofCount.size(); k-- > 0;)
      ofCount[k] = (1.0 - p) * ofCount[k] + (k > 0 ? p * ofCount[k - 1] : 0.0);
  }
  if (s.n == 0) return {};
  const auto n = static_cast<double>(s.n);
  const auto quantile = [&](double share) {
    double sum = 0.0;
    for (std::size_t k = 0; k < ofCount.size(); ++k)
      if ((sum += ofCount[k]) >= share) return static_cast<double>(k) / n;
    return 1.0;
  };
  s.expected /= n;
  s.low = quantile(0.025);
  s.high = quantile(0.975);
  return s;
}

RetractionStudy retractionStudy(const std::vector<CaseRecord>& records) {
  RetractionStudy s;
  s.tried = records.size();
  std::size_t within = 0, significant = 0, travelled = 0;
  std::vector<double> pWithin, pSignificant, pTravelled;
  for (const CaseRecord& r : records) {
    if (r.outcome.status == CaseOutcome::Status::Rejected) ++s.rejected;
    if (r.outcome.status == CaseOutcome::Status::Failed) ++s.failed;
    if (r.outcome.status != CaseOutcome::Status::Done || !std::isfinite(r.mean_mm)) continue;
    s.mean_mm.push_back(r.mean_mm);
    s.at_retractor_mm.push_back(r.at_retractor_mm);
    pWithin.push_back(r.probability_within_voxel);
    pSignificant.push_back(r.probability_beyond_5mm);
    pTravelled.push_back(r.probability_travel_beyond_5mm);
    if (r.mean_mm <= defaults::mriVoxel.mm()) ++within;
    if (r.at_retractor_mm >= defaults::clinicallySignificant.mm()) ++significant;
    if (!std::isfinite(r.travel_difference_mm)) continue;
    s.travel_mm.push_back(std::abs(r.travel_difference_mm));
    if (s.travel_mm.back() >= defaults::clinicallySignificant.mm()) ++travelled;
  }
  s.left = s.mean_mm.size();
  s.sureWithinVoxel = sureShareOf(pWithin);
  s.sureSignificant = sureShareOf(pSignificant);
  s.sureTravelSignificant = sureShareOf(pTravelled);
  s.mean = spreadOf(s.mean_mm);
  s.atRetractor = spreadOf(s.at_retractor_mm);
  s.travel = spreadOf(s.travel_mm);
  if (!s.travel_mm.empty())
    s.fractionTravelSignificant = static_cast<double>(travelled) / static_cast<double>(s.travel_mm.size());
  if (s.left > 0) {
    s.fractionWithinVoxel = static_cast<double>(within) / static_cast<double>(s.left);
    s.fractionSignificant = static_cast<double>(significant) / static_cast<double>(s.left);
  }
  return s;
}

std::vector<Chosen> chooseCases(const std::vector<CaseRecord>& records) {
  std::vector<const CaseRecord*> left;
  std::vector<double> values;
  for (const CaseRecord& r : records)
    if (r.outcome.status == CaseOutcome::Status::Done && std::isfinite(r.at_retractor_mm)) {
      left.push_back(&r);
      values.push_back(r.at_retractor_mm);
    }
  std::vector<Chosen> chosen;
  if (left.empty()) return chosen;
  const Spread s = spreadOf(values);
  // The outlier is chosen first, so that no other place takes it away.
  const auto take = [&](const char* what, double wanted_mm) {
    if (left.empty()) return;
    const auto away = [&](const CaseRecord* r) { return std::abs(r->at_retractor_mm - wanted_mm); };
    const auto best = std::min_element(left.begin(), left.end(), [&](const CaseRecord* a, const CaseRecord* b) {
      return a->drawable != b->drawable ? a->drawable : away(a) < away(b);
    });
    const auto nearer =
        std::count_if(left.begin(), left.end(), [&](const CaseRecord* r) { return away(r) < away(*best); });
    chosen.push_back({what, (*best)->outcome.id, (*best)->at_retractor_mm,
                      static_cast<std::size_t>((*best)->drawable ? nearer : 0)});
    left.erase(best);
  };
  if (left.size() > 1) take("outlier", s.max);
  take("mean", s.mean);
  take("+1 SD", s.mean + s.sd);
  take("+2 SD", s.mean + 2.0 * s.sd);
  if (chosen.size() > 1) std::rotate(chosen.begin(), chosen.begin() + 1, chosen.end());
  return chosen;
}

}  // namespace glisson::cohort
