// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/series_facts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "base/map_unit.h"
#include "base/text.h"
#include "dicom/product_words.h"

namespace glisson::dicom {
namespace {

std::string listed(const std::map<std::string, std::size_t>& counts) {
  std::string all;
  for (const auto& [name, count] : counts) all += (all.empty() ? "" : ", ") + name;
  return all;
}

bool oneScale(const std::vector<SliceFacts>& slices) {
  const Frame& first = *slices.front().frame;
  return std::all_of(slices.begin(), slices.end(), [&](const SliceFacts& s) {
    return s.frame->map == first.map && s.frame->rescale == first.rescale;
  });
}

void takeUnit(const std::vector<SliceFacts>& slices, Series& series) {
  std::map<std::string, std::size_t> counts;
  std::size_t without = 0;
  for (const SliceFacts& s : slices)
    if (s.frame->unit.empty())
      ++without;
    else
      ++counts[s.frame->unit];
  if (counts.empty()) return;
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  series.unit = most->first;
  const auto unit = mapUnit(most->first);
  const bool alike = std::all_of(counts.begin(), counts.end(), [&](const auto& other) {
    const auto known = mapUnit(other.first);
    return known && unit && known->of == unit->of;
  });
  if (counts.size() > 1 && alike)
    tell(series, DiagnosticCode::UnitsDiffer, {{"units", listed(counts)}, {"unit", *series.unit}});
  else if (counts.size() > 1)
    series.noScale = "its slices are in units that cannot be turned into each other (" + listed(counts) + ")";
  if (without > 0 && !oneScale(slices))
    series.noScale = std::to_string(without) + " of its " + std::to_string(slices.size()) +
                     " slices name no unit and have another scale than the others (" + listed(counts) + ")";
}

/// Young's modulus, where only words beside the description name it: it is read as three times the shear modulus. Other
/// words there tell of the way that a map was computed.
void takeQuantityByWords(const SliceFacts& first, Series& series) {
  const ImageHeader& h = *first.header;
  std::string about = h.imageType;
  for (const auto& [what, words] : first.frame->kinds)
    if (what == FrameKind::WordsAboutValues) about += ' ' + words;
  const auto unit = mapUnit(series.unit.value_or(unitInWords(h.description).value_or("")));
  if (!unit || unit->of != MapUnit::Of::Modulus || quantityInWords(h.description) ||
      quantityInWords(about) != MapQuantity::YoungsModulus)
    return;
  series.quantity = MapQuantity::YoungsModulus;
  tell(series, DiagnosticCode::QuantityByWords, {{"quantity", inWords(*series.quantity)}});
}

void takeQuantity(const std::vector<SliceFacts>& slices, Series& series) {
  std::set<std::string> names;
  std::size_t without = 0;
  for (const SliceFacts& s : slices) {
    if (!s.frame->quantity) {
      ++without;
      continue;
    }
    series.quantity = s.frame->quantity;
    names.insert(inWords(*s.frame->quantity));
  }
  if (without > 0 && series.quantity && *series.quantity != MapQuantity::ShearModulus)
    series.noScale = std::to_string(without) + " of its " + std::to_string(slices.size()) +
                     " slices do not say what they hold, the others hold " + *names.begin();
  if (names.empty()) takeQuantityByWords(slices.front(), series);
  if (names.size() > 1) series.noScale = "its slices hold different quantities: " + *names.begin() + " and others";
}

void takeScale(const std::vector<SliceFacts>& slices, Series& series) {
  std::set<ScaleDoubt> doubts;
  for (const SliceFacts& s : slices) {
    doubts.insert(s.frame->scaleDoubt);
    series.acquired.rescaled = series.acquired.rescaled || s.frame->map >= 0 || !(s.frame->rescale == Rescale{});
    const auto own = s.header->privateScale;
    if (own && s.frame->map < 0 && s.frame->unit.empty() && std::abs(*own * s.frame->rescale.slope - 1.0) > 1e-6 &&
        lowerCase(s.header->manufacturer).find("philips") != std::string::npos)
      series.acquired.privateScale = own;
  }
  if (doubts.count(ScaleDoubt::MapsDisagree) > 0)
    series.noScale = "its real-world value maps give different values for one stored value";
  if (doubts.count(ScaleDoubt::UnitUnclear) > 0)
    series.noScale = "its real-world value map names one unit by its code and another one in words";
  if (doubts.count(ScaleDoubt::TableUnread) > 0)
    series.noScale = "its stored values mean something only by a modality look-up table (0028,3000), which is not read";
  if (doubts.count(ScaleDoubt::NoScale) > 0) tell(series, DiagnosticCode::MapWithoutScale, {});
  if (doubts.count(ScaleDoubt::MapUsed) > 0)
    tell(series, DiagnosticCode::ScalesDiffer,
         {{"used", std::string("map")}, {"because", std::string("alone names a unit of stiffness")}});
  if (doubts.count(ScaleDoubt::RescaleUsed) > 0)
    tell(series, DiagnosticCode::ScalesDiffer,
         {{"used", std::string("rescale")}, {"because", std::string("is what every reader applies")}});
}

void takeAcquisition(const std::vector<SliceFacts>& slices, Series& series) {
  constexpr std::size_t mostReferences = 4096;
  const ImageHeader& h = *slices.front().header;
  Acquired& a = series.acquired;
  a.uid = h.acquisitionUid;
  a.number = h.acquisitionNumber;
  a.manufacturer = h.manufacturer;
  a.sequenceName = h.sequenceName;
  a.imageType = h.imageType;
  a.elastographyStep = h.step.time >= 0;
  for (const auto& [what, value] : slices.front().frame->kinds)
    if (what == FrameKind::ImageType) a.imageType = value;
  std::set<std::string> references;
  const ImageHeader* before = nullptr;
  for (const SliceFacts& s : slices) {
    a.phaseCoded = a.phaseCoded || std::any_of(s.frame->kinds.begin(), s.frame->kinds.end(), [](const auto& k) {
                     return k.first == FrameKind::PrivateImageType && k.second != "0";
                   });
    if (s.header == before) continue;
    before = s.header;
    if (s.header->acquisitionUid != a.uid) a.uid.clear();
    if (s.header->acquisitionNumber != a.number) a.number.reset();
    if (s.header->acquisition_s)
      a.time_s = a.time_s ? std::min(*a.time_s, *s.header->acquisition_s) : s.header->acquisition_s;
    if (references.size() < mostReferences) references.insert(s.header->references.begin(), s.header->references.end());
  }
  a.references.assign(references.begin(), references.end());
}

/// Padding that only some of the slices tell.
void takePadding(const std::vector<SliceFacts>& slices, Series& series) {
  const auto with =
      std::count_if(slices.begin(), slices.end(), [](const SliceFacts& s) { return s.header->padding.has_value(); });
  if (with > 0 && static_cast<std::size_t>(with) < slices.size())
    tell(series, DiagnosticCode::PaddingInPart,
         {{"with", static_cast<std::int64_t>(with)}, {"slices", static_cast<std::int64_t>(slices.size())}});
}

}  // namespace

void takeFacts(const std::vector<SliceFacts>& slices, Series& series) {
  takePadding(slices, series);
  takeUnit(slices, series);
  takeQuantity(slices, series);
  takeScale(slices, series);
  takeAcquisition(slices, series);
}

void tell(Series& series, DiagnosticCode code, std::vector<std::pair<std::string, DiagnosticValue>> arguments) {
  series.diagnostics.add(code, std::move(arguments));
  series.warnings.push_back(std::prev(series.diagnostics.end())->text());
}

}  // namespace glisson::dicom
