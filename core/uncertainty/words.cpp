// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <sstream>

#include "uncertainty/propagate.h"

namespace glisson::uncertainty {
namespace {

std::string twoLargest(std::vector<SourceSpread> sources) {
  std::stable_sort(sources.begin(), sources.end(),
                   [](const SourceSpread& a, const SourceSpread& b) { return a.sd_mm > b.sd_mm; });
  std::ostringstream t;
  t.precision(2);
  for (std::size_t i = 0; i < std::min<std::size_t>(2, sources.size()); ++i)
    t << (i == 0 ? "" : " and ") << wordsOf(sources[i].kind, {}, 0.0).name << " (± " << sources[i].sd_mm << " mm)";
  return t.str();
}

double rmsOf(const std::vector<LandmarkSpread>& landmarks) {
  double sum = 0;
  for (const LandmarkSpread& l : landmarks) sum += l.sd_mm * l.sd_mm;
  return landmarks.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(landmarks.size()));
}

}  // namespace

std::string inWords(const Spread& s) {
  std::ostringstream t;
  t.precision(3);
  if (s.headline)
    t << "what the retractor holds lies, with 95 % probability, between " << s.headline->at_retractor_mm.low << " and "
      << s.headline->at_retractor_mm.high << " mm from where the textbook stiffness puts it; that it is "
      << defaults::clinicallySignificant.mm() << " mm or more has a probability of "
      << std::lround(100 * s.headline->beyond) << " %";
  else
    t << "the vessels are placed to ± " << rmsOf(s.landmarks) << " mm (one standard deviation)";
  t << "; most of this comes from " << twoLargest(s.sources);
  return t.str();
}

}  // namespace glisson::uncertainty
