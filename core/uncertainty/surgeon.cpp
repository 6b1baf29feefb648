// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/surgeon.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/quantity.h"
#include "base/random.h"

namespace glisson::uncertainty {
namespace {

using Eigen::Index;

/// Squares of standard normal vectors, 3 × draws.
const Eigen::Matrix3Xd& squaredNormals() {
  static const Eigen::Matrix3Xd squares = [] {
    constexpr Index draws = 8000;
    Random random(20);
    Eigen::Matrix3Xd z(3, draws);
    for (double& v : z.reshaped()) v = random.normal();
    return Eigen::Matrix3Xd(z.array().square());
  }();
  return squares;
}

std::string ofTip(const VesselTip& tip, Language language) {
  const auto mm = [&](double v) { return millimetres(v, language); };
  if (!tip.apart_mm)
    return phrase(
        "The vessel tip whose place is least sure moves by @ when the liver is retracted, and with 95 % probability it "
        "then lies within @ of the place shown",
        language, {mm(tip.moves_mm), mm(tip.place95_mm)});
  return phrase(
      "The vessel tip that the two predictions set furthest apart moves by @ when the liver is retracted, and with "
      "95 % probability it then lies within @ of the place shown; the textbook stiffness puts it @ away (95 %: @), and "
      "the chance that this is @ or more is @",
      language,
      {mm(tip.moves_mm), mm(tip.place95_mm), mm(*tip.apart_mm), rangeOf(*tip.apart95_mm, language),
       mm(defaults::clinicallySignificant.mm()), percent(*tip.beyond, language)});
}

std::string ofRetractor(const Headline& h, Language language) {
  return phrase(
      "The tissue on the retractor lies, with 95 % probability, @ from where the textbook stiffness puts it; the "
      "chance that this is @ or more is @",
      language,
      {rangeOf(h.at_retractor_mm, language), millimetres(defaults::clinicallySignificant.mm(), language),
       percent(h.beyond, language)});
}

const char* labelOf(SourceKind kind) {
  switch (kind) {
    case SourceKind::ElastogramNoise: return "elastogram: noise";
    case SourceKind::ElastogramRepeatability: return "elastogram: repeatability";
    case SourceKind::Outline: return "outline of the liver";
    case SourceKind::Poisson: return "Poisson's ratio";
    case SourceKind::Supports: return "what holds the liver";
    case SourceKind::Capsule: return "capsule";
    case SourceKind::Force: return "force on the bar";
    case SourceKind::Density: return "density";
    case SourceKind::BarPlace: return "place of the bar";
    case SourceKind::BarDirection: return "direction of the bar";
    case SourceKind::Cells: return "size of the cells";
    case SourceKind::Kinematics: return "linear theory";
    case SourceKind::Solver: return "solver";
    case SourceKind::BeyondFirstOrder: break;
  }
  return "beyond first order";
}

}  // namespace

std::string millimetres(double mm, Language language) {
  char text[32];
  if (mm != 0.0 && std::abs(mm) < 0.05) return inLanguage("< 0.1 mm", language);
  std::snprintf(text, sizeof text, std::abs(mm) < 9.95 && mm != std::round(mm) ? "%.1f mm" : "%.0f mm", mm);
  return inLanguage(text, language);
}

std::string percent(double probability, Language language) {
  if (probability < 0.01) return phrase("less than 1 %", language);
  if (probability > 0.99) return phrase("more than 99 %", language);
  return std::to_string(std::lround(100 * probability)) + " %";
}

std::string rangeOf(const Interval& i, Language language) {
  const auto plain = [&](double mm) {
    const std::string text = millimetres(mm, language);
    return text.substr(0, text.rfind(" mm"));
  };
  return phrase("@ to @ mm", language, {plain(i.low), plain(i.high)});
}

double radius95_mm(const Eigen::Matrix3d& covariance_mm2) {
  const Eigen::Vector3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance_mm2, Eigen::EigenvaluesOnly)
                                   .eigenvalues()
                                   .cwiseMax(0.0);
  Eigen::VectorXd squares = squaredNormals().transpose() * axes;
  const Index at = static_cast<Index>(0.95 * static_cast<double>(squares.size()));
  std::nth_element(squares.begin(), squares.begin() + at, squares.end());
  return std::sqrt(squares[at]);
}

std::optional<VesselTip> tipOf(const FirstOrder& first, const Spread& spread, const std::vector<std::size_t>& tips) {
  std::optional<VesselTip> told;
  const auto& all = first.places.landmark;
  for (const std::size_t tip : tips) {
    const auto found = std::find(all.begin(), all.end(), tip);
    if (found == all.end()) continue;
    const auto place = static_cast<std::size_t>(found - all.begin());
    const LandmarkSpread& s = spread.landmarks[place];
    const auto at = static_cast<Index>(3 * place);
    VesselTip t;
    t.landmark = tip;
    t.moves_mm = static_cast<double>(first.measured.segment<3>(at).norm());
    t.place95_mm = radius95_mm(s.place_mm2);
    if (s.difference95_mm) {
      t.apart_mm = static_cast<double>((first.measured - first.textbook).segment<3>(at).norm());
      t.apart95_mm = s.difference95_mm;
      t.beyond = s.beyond;
    }
    if (!told || (t.apart_mm ? *t.apart_mm > *told->apart_mm : t.place95_mm > told->place95_mm)) told = t;
  }
  return told;
}

std::string forSurgeon(const std::optional<VesselTip>& tip, const Spread& spread, Language language) {
  if (tip) return ofTip(*tip, language);
  return spread.headline ? ofRetractor(*spread.headline, language) : std::string();
}

std::string labelOf(SourceKind kind, Language language) {
  return phrase(labelOf(kind), language);
}

}  // namespace glisson::uncertainty
