// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/frame_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "base/map_unit.h"
#include "base/text.h"
#include "dicom/detail/attributes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

namespace glisson::dicom {
namespace {

constexpr std::size_t largestTable = 1U << 20;

/// One item of a RealWorldValueMappingSequence.
struct MapItem {
  ValueSegment segment;
  bool bounded = false;  ///< says which stored values it is defined for
  std::string unit;
  bool unitUnclear = false;  ///< its code and its words name different ones
  std::optional<MapQuantity> quantity;

  bool ofStiffness() const { return mapUnit(unit).has_value() || (quantity && *quantity != MapQuantity::Other); }
};

bool close(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b));
}

/// kPa (or m/s) for each of the unit; 1 where it is none of stiffness.
double factorOf(const std::string& unit) {
  const auto known = mapUnit(unit);
  return known ? known->factor : 1.0;
}

/// A stored value as the pixels count: files write signed ones as unsigned where the attribute's VR is ambiguous.
double asStored(double value, const ImageHeader& h) {
  if (h.kind != PixelKind::Integer || !h.isSigned || h.bitsStored > 16) return value;
  const double all = std::exp2(h.bitsStored);
  return value >= 0.5 * all && value < all ? value - all : value;
}

std::optional<double> limit(DcmItem& item, const DcmTagKey& integer, const DcmTagKey& real) {
  const auto value = number(item, real);
  return value ? value : number(item, integer);
}

/// Tables of more than 64 KiB stand as raw bytes in explicit encodings.
std::vector<double> tableOf(DcmItem& item, bool bigEndian) {
  const Float64* values = nullptr;
  unsigned long count = 0;
  DcmElement* element = nullptr;
  if (item.findAndGetElement(DCM_RealWorldValueLUTData, element).bad() || element == nullptr) return {};
  std::vector<double> table;
  Uint8* raw = nullptr;
  const std::size_t bytes = element->getLength();
  if (item.findAndGetFloat64Array(DCM_RealWorldValueLUTData, values, &count).good() && values != nullptr) {
    if (count > largestTable) throw BadInput(nameOf(DCM_RealWorldValueLUTData) + " has too many entries");
    table.assign(values, values + count);
  } else if (!bigEndian && bytes % sizeof(double) == 0 && bytes <= sizeof(double) * largestTable &&
             element->getUint8Array(raw).good() && raw != nullptr) {
    table.resize(bytes / sizeof(double));
    std::memcpy(table.data(), raw, bytes);
  } else if (bytes > 0) {
    throw BadInput(nameOf(DCM_RealWorldValueLUTData) + " cannot be read as a table of numbers");
  }
  for (const double v : table)
    if (!std::isfinite(v)) throw BadInput(nameOf(DCM_RealWorldValueLUTData) + " holds a value that is not finite");
  return table;
}

std::optional<MapQuantity> quantityOf(DcmItem& item) {
  for (unsigned long n = 0; n < itemCount(item, DCM_QuantityDefinitionSequence); ++n) {
    DcmItem& definition = *itemOf(item, DCM_QuantityDefinitionSequence, n);
    DcmItem* concept_ = itemOf(definition, DCM_ConceptNameCodeSequence);
    DcmItem* value = itemOf(definition, DCM_ConceptCodeSequence);
    if (concept_ == nullptr || value == nullptr) continue;
    const std::string name = shownText(*concept_, DCM_CodeValue);
    const bool quantity = name == "246205007" || name == "G-C1C6" ||
                          lowerCase(shownText(*concept_, DCM_CodeMeaning)).find("quantity") != std::string::npos;
    if (quantity)
      return quantityOfCode(shownText(*value, DCM_CodingSchemeDesignator), shownText(*value, DCM_CodeValue),
                            shownText(*value, DCM_CodeMeaning));
  }
  return std::nullopt;
}

/// Empty where the item gives no scale.
std::optional<MapItem> readItem(DcmItem& item, const ImageHeader& h) {
  MapItem map;
  if (DcmItem* units = itemOf(item, DCM_MeasurementUnitsCodeSequence)) {
    const std::string code = shownText(*units, DCM_CodeValue), meaning = shownText(*units, DCM_CodeMeaning);
    map.unit = canonicalUnit(mapUnit(code) || !mapUnit(meaning) ? code : meaning);
    map.unitUnclear = mapUnit(code) && mapUnit(meaning) && canonicalUnit(code) != canonicalUnit(meaning);
  }
  map.quantity = quantityOf(item);
  auto first = limit(item, DCM_RealWorldValueFirstValueMapped, DCM_DoubleFloatRealWorldValueFirstValueMapped);
  auto last = limit(item, DCM_RealWorldValueLastValueMapped, DCM_DoubleFloatRealWorldValueLastValueMapped);
  if (first && last && asStored(*first, h) <= asStored(*last, h)) {
    first = asStored(*first, h);
    last = asStored(*last, h);
  }
  map.segment.table = tableOf(item, h.layout.bigEndian);
  if (!map.segment.table.empty()) {
    if (!first) return std::nullopt;
    map.segment.first = *first;
    map.segment.last = *first + static_cast<double>(map.segment.table.size()) - 1.0;
    map.bounded = true;
    return map;
  }
  const auto slope = number(item, DCM_RealWorldValueSlope), intercept = number(item, DCM_RealWorldValueIntercept);
  if (!slope || !intercept || *slope == 0.0) return std::nullopt;
  map.segment.line = {*slope, *intercept};
  if (first && last && *first > *last) std::swap(first, last);
  map.bounded = first && last && *first < *last;
  if (map.bounded) {
    // Limits of floating point pixels are often written with fewer digits than the pixels have.
    const double slack = h.kind == PixelKind::Integer ? 0.0 : 1e-6 * std::max(std::abs(*first), std::abs(*last));
    map.segment.first = *first - slack;
    map.segment.last = *last + slack;
  } else {
    map.segment.first = -1e300;
    map.segment.last = 1e300;
  }
  return map;
}

/// Items that give no scale are left out, and doubted.
std::vector<MapItem> itemsOf(DcmItem* mapping, const ImageHeader& h, Frame& frame) {
  std::vector<MapItem> items;
  if (mapping == nullptr) return items;
  for (unsigned long n = 0; n < itemCount(*mapping, DCM_RealWorldValueMappingSequence); ++n)
    if (auto map = readItem(*itemOf(*mapping, DCM_RealWorldValueMappingSequence, n), h))
      items.push_back(std::move(*map));
    else
      frame.scaleDoubt = ScaleDoubt::NoScale;
  return items;
}

/// What an item makes of a stored value that it is defined for, in the unit that its own is counted in.
double valueAt(const MapItem& item, double stored) {
  const ValueSegment& s = item.segment;
  const double value = s.table.empty() ? s.line.slope * stored + s.line.intercept
                                       : s.table[static_cast<std::size_t>(std::lround(stored - s.first))];
  return factorOf(item.unit) * value;
}

/// Whether two items give the same value, in one unit, wherever both are defined.
bool agree(const MapItem& a, const MapItem& b) {
  const double first = std::max({a.segment.first, b.segment.first, -1e5});
  const double last = std::min({a.segment.last, b.segment.last, 1e5});
  if (last - first < 1.0) return true;  // pieces that meet
  const double middle = std::floor(0.5 * (first + last));
  const double scale = std::abs(valueAt(a, last)) + std::abs(valueAt(a, first));
  for (const double stored : {first, middle, last})
    if (std::abs(valueAt(a, stored) - valueAt(b, stored)) > 1e-6 * scale) return false;
  return true;
}

bool agree(const MapItem& item, const Rescale& rescale, const std::string& unit) {
  MapItem other;
  other.segment = {-1e300, 1e300, rescale, {}};
  other.unit = unit.empty() ? item.unit : unit;
  return agree(item, other);
}

/// Which of a map's quantities is wanted most: MR elastography reports the shear modulus.
int rank(const std::optional<MapQuantity>& quantity) {
  if (!quantity) return 1;
  switch (*quantity) {
    case MapQuantity::ShearModulus: return 0;
    case MapQuantity::YoungsModulus: return 2;
    case MapQuantity::WaveSpeed: return 3;
    default: return 4;
  }
}

/// Uses the best of these items, with all others of its unit and quantity: one map may come in pieces.
void useMap(std::vector<MapItem> items, Frame& frame, ImageHeader& header) {
  std::stable_sort(items.begin(), items.end(),
                   [](const MapItem& a, const MapItem& b) { return rank(a.quantity) < rank(b.quantity); });
  const MapItem& best = items.front();
  ValueMap map;
  for (MapItem& item : items) {
    if (item.quantity != best.quantity) continue;
    if (&item != &best && !agree(item, best)) frame.scaleDoubt = ScaleDoubt::MapsDisagree;
    if (const double f = factorOf(item.unit) / factorOf(best.unit); !close(f, 1.0)) {
      item.segment.line = {f * item.segment.line.slope, f * item.segment.line.intercept};
      for (double& v : item.segment.table) v *= f;
    }
    if (item.unitUnclear) frame.scaleDoubt = ScaleDoubt::UnitUnclear;
    map.push_back(item.segment);
  }
  frame.unit = best.unit == "1" ? std::string() : best.unit;
  frame.quantity = best.quantity;
  // A line without limits is what the rest of the program calls a rescale.
  if (map.size() == 1 && !best.bounded) {
    frame.rescale = map.front().line;
    return;
  }
  const auto known = std::find(header.maps.begin(), header.maps.end(), map);
  frame.map = static_cast<int>(known - header.maps.begin());
  if (known == header.maps.end()) header.maps.push_back(std::move(map));
}

}  // namespace

void readValues(DcmItem& transformation, DcmItem* mapping, Frame& frame, ImageHeader& header) {
  const auto slope = number(transformation, DCM_RescaleSlope);
  const auto intercept = number(transformation, DCM_RescaleIntercept);
  if (slope.has_value() != intercept.has_value())
    throw BadInput("has only one of " + nameOf(DCM_RescaleSlope) + " and " + nameOf(DCM_RescaleIntercept) +
                   "; the stored values cannot be turned into measured ones");
  if (slope && *slope == 0.0) throw BadInput(nameOf(DCM_RescaleSlope) + " is 0");
  if (slope) frame.rescale = {*slope, *intercept};
  const std::string type = shownText(transformation, DCM_RescaleType);
  const std::string small = lowerCase(type);
  if (small != "us" && small != "normalized" && small != "unspecified" && small != "1")
    frame.unit = canonicalUnit(type);

  std::vector<MapItem> items = itemsOf(mapping, header, frame), stiffness;
  std::copy_if(items.begin(), items.end(), std::back_inserter(stiffness),
               [](const MapItem& item) { return item.ofStiffness(); });
  if (stiffness.empty() && itemOf(transformation, DCM_ModalityLUTSequence) != nullptr) {
    frame.scaleDoubt = ScaleDoubt::TableUnread;
    return;
  }
  if (items.empty()) return;
  if (slope && mapUnit(frame.unit)) {
    if (stiffness.empty()) return;
    const auto same = std::find_if(stiffness.begin(), stiffness.end(),
                                   [&](const MapItem& item) { return agree(item, frame.rescale, frame.unit); });
    if (same != stiffness.end())
      useMap({*same}, frame, header);
    else
      frame.scaleDoubt = ScaleDoubt::RescaleUsed;
    return;
  }
  if (!stiffness.empty()) {
    const bool other = slope && !(frame.rescale == Rescale{}) && !agree(stiffness.front(), frame.rescale, {});
    useMap(std::move(stiffness), frame, header);
    if (other && frame.scaleDoubt != ScaleDoubt::MapsDisagree) frame.scaleDoubt = ScaleDoubt::MapUsed;
    return;
  }
  if (!slope) {
    useMap({items.front()}, frame, header);
  } else if (agree(items.front(), frame.rescale, {})) {
    if (frame.unit.empty() && items.front().unit != "1") frame.unit = items.front().unit;
  } else {
    frame.scaleDoubt = ScaleDoubt::RescaleUsed;
  }
}

void readPadding(DcmItem& data, ImageHeader& header) {
  const auto value = [&](const DcmTagKey& tag) -> std::optional<double> {
    try {
      const auto found = number(data, tag);
      return found ? std::optional(asStored(*found, header)) : std::nullopt;
    } catch (const BadInput&) {
      return std::nullopt;
    }
  };
  const bool integer = header.kind == PixelKind::Integer, single = header.kind == PixelKind::Float;
  const auto from = value(integer  ? DCM_PixelPaddingValue
                          : single ? DCM_FloatPixelPaddingValue
                                   : DCM_DoubleFloatPixelPaddingValue);
  const auto to = value(integer  ? DCM_PixelPaddingRangeLimit
                        : single ? DCM_FloatPixelPaddingRangeLimit
                                 : DCM_DoubleFloatPixelPaddingRangeLimit);
  if (from) header.padding = std::minmax(*from, to.value_or(*from));
}

}  // namespace glisson::dicom
