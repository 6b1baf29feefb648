// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/roles.h"

#include <algorithm>
#include <initializer_list>
#include <tuple>

#include "base/error.h"
#include "base/map_unit.h"
#include "base/text.h"
#include "dicom/product_words.h"

namespace glisson::dicom {
namespace {

const char* firstOf(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (text.find(word) != std::string::npos) return word;
  return nullptr;
}

constexpr const char* byHand = "set by hand";

/// Of a product, for a reason.
std::string meaning(const Product& product) {
  switch (product.role) {
    case SeriesRole::Confidence: return "confidence map";
    case SeriesRole::Stiffness: return product.masked ? "masked stiffness map" : "stiffness map";
    default: return "wave images";
  }
}

void set(Series& s, SeriesRole role, const std::string& reason) {
  s.role = role;
  s.roleReason = reason;
}

void contradict(Series& s, const char* by, const char* against, SeriesRole other) {
  tell(s, DiagnosticCode::RoleContradicted,
       {{"role", name(s.role)},
        {"by", std::string(by)},
        {"against", std::string(against)},
        {"other", other == SeriesRole::Other ? std::string("another quantity") : name(other)}});
}

/// GE's maps are in Pa, unless the file says otherwise; once somebody has rescaled them, only the file can say.
void setGeUnit(Series& s) {
  const auto words = unitInWords(s.description);
  if (s.unit && mapUnit(*s.unit)) {
    if (*s.unit != "Pa") tell(s, DiagnosticCode::UnitAgainstVendor, {{"usual", std::string("Pa")}, {"unit", *s.unit}});
  } else if (words && *words != "Pa") {
    s.unit = *words;
    tell(s, DiagnosticCode::UnitByWords, {{"usual", std::string("Pa")}, {"unit", *words}});
  } else if (!s.acquired.rescaled) {
    s.unit = "Pa";
  }
}

/// GE numbers the products of one MRE acquisition N: 100 N + 1 stiffness, + 5 wave, + 7 confidence.
void setGeRole(Series& s, const std::string& sequence, std::size_t phases) {
  const int product = s.number >= 100 ? s.number % 100 : 0;
  const std::string where = "GE sequence '" + sequence + "', series number " + std::to_string(s.number);
  const bool echoPlanar = sequence.find("epimre") != std::string::npos;
  const auto named = productNamed(s.description, false);
  const bool derived = lowerCase(s.acquired.imageType).starts_with("derived");
  if (product == 1) {
    set(s, SeriesRole::Stiffness, where + " (ends in 01: stiffness in Pa)");
  } else if (product == 5) {
    set(s, SeriesRole::Wave, where + " (ends in 05: processed wave image)");
  } else if (product == 7 && !echoPlanar && phases > 1) {
    set(s, SeriesRole::Wave,
        where + " (ends in 07 with " + std::to_string(phases) + " phases: wave on the gradient-echo sequence)");
  } else if (product == 7) {
    set(s, SeriesRole::Confidence, where + " (ends in 07: confidence 0 to 999)");
  } else if (product != 0) {
    set(s, SeriesRole::Other, where + " (no product that is used)");
    return;
  } else if (named && derived) {
    // Renumbered by somebody: what it is called counts.
    set(s, named->role, where + " (no number of a product), series description holds '" + named->word + "'");
    s.masked = named->masked;
  } else if (s.acquired.phaseCoded && phases == 1) {
    set(s, SeriesRole::Phase, where + " (raw phase images)");
  } else {
    set(s, SeriesRole::Magnitude, where + " (the acquisition itself: magnitude)");
  }
  if (product != 0 && named && named->role != s.role)
    contradict(s, "its series number", "its description", named->role);
  if (s.role == SeriesRole::Stiffness) setGeUnit(s);
}

/// Siemens ("MR Elastography": products by the end of the series description or a part of the image type) and Philips
/// ("MRE": products by image type). Both write maps of the same words; nothing is taken from private scale factors.
/// True where one applies.
bool setVendorRole(Series& s) {
  const std::string maker = lowerCase(s.acquired.manufacturer);
  const char* vendor = maker.find("siemens") != std::string::npos   ? "Siemens"
                       : maker.find("philips") != std::string::npos ? "Philips"
                                                                    : nullptr;
  if (vendor == nullptr) return false;
  const std::string description = lowerCase(s.description);
  const std::string type = lowerCase(s.acquired.imageType);
  const std::string sequence = lowerCase(s.acquired.sequenceName);
  if (firstOf(description + "\\" + type + "\\" + sequence, {"mre", "elasto", "stiff"}) == nullptr &&
      !s.acquired.elastographyStep)
    return false;
  const auto byType = productNamed(type, true), byWords = productNamed(description, true);
  if (byType || byWords) {
    const Product& product = byType ? *byType : *byWords;
    set(s, product.role,
        std::string(vendor) + " elastography, " + (byType ? "image type" : "series description") + " holds '" +
            product.word + "': " + (product.role == SeriesRole::Other ? "no product that is used" : meaning(product)));
    s.masked = product.masked || (byWords && byWords->masked);
    if (byType && byWords && byType->role != byWords->role)
      contradict(s, "its image type", "its description", byWords->role);
    return true;
  }
  const bool phase =
      type.find("\\p\\") != std::string::npos || type.ends_with("\\p") || type.find("phase") != std::string::npos;
  const bool magnitude =
      type.find("\\m\\") != std::string::npos || type.ends_with("\\m") || type.find("magnitude") != std::string::npos;
  if (!phase && !magnitude) return false;
  set(s, phase ? SeriesRole::Phase : SeriesRole::Magnitude,
      std::string(vendor) + " elastography, image type '" + s.acquired.imageType.substr(0, 40) +
          "': " + (phase ? "raw phase images" : "magnitude"));
  return true;
}

/// The part of the complex signal that an image holds, where it is not the magnitude; null where it is, or is not said.
const char* partOfSignal(const Series& s, const std::string& type) {
  const std::string all = type + '\\';
  if (all.find("\\r\\") != std::string::npos || all.find("\\real\\") != std::string::npos) return "real";
  if (all.find("\\i\\") != std::string::npos || all.find("\\imaginary\\") != std::string::npos) return "imaginary";
  return s.acquired.phaseCoded ? "real, imaginary or phase" : nullptr;
}

void setByDescription(Series& s) {
  const std::string description = lowerCase(s.description);
  const std::string type = lowerCase(s.acquired.imageType);
  const std::string all = description + "\\" + type;
  const auto because = [&](const std::string& word) {
    return std::string(description.find(word) != std::string::npos ? "series description" : "image type") + " holds '" +
           word + "'";
  };
  const bool derivedMre = firstOf(all, {"mre", "elasto", "shear", "stiff", "mr touch", "mrtouch"}) != nullptr;
  const bool named = firstOf(all, {"mre", "elasto", "stiff", "mr touch", "mrtouch"}) != nullptr;
  const auto byType = productNamed(type, false), byWords = productNamed(description, named);
  if (byType || byWords) {
    const Product& product = byType ? *byType : *byWords;
    set(s, product.role, std::string(byType ? "image type" : "series description") + " holds '" + product.word + "'");
    s.masked = product.masked || (byWords && byWords->masked);
    if (byType && byWords && byType->role != byWords->role)
      contradict(s, "its image type", "its description", byWords->role);
  } else if (derivedMre && (type.find("\\p\\") != std::string::npos || firstOf(description, {"phase"}) != nullptr)) {
    set(s, SeriesRole::Phase, "raw phase images of an elastography series");
  } else if (const char* signal = partOfSignal(s, type)) {
    set(s, SeriesRole::Other, std::string("it holds the ") + signal + " part of the signal, no picture of the anatomy");
  } else if (const char* mre = firstOf(all, {"mre", "elasto", "magnitude"})) {
    set(s, SeriesRole::Magnitude, because(mre));
  } else if (const char* part =
                 firstOf(all, {"localizer", "localiser", "scout", "calibration", "screen save", "report"})) {
    set(s, SeriesRole::Other, because(part));
  } else if (const char* map = firstOf(type, {"\\adc", "\\fa\\", "\\t1 map", "\\t2 map", "\\p\\", "phase map"})) {
    set(s, SeriesRole::Other, because(map));
  } else if (const char* quantity = firstOf(description, {"apparent diffusion", "adc map", "fractional anisotropy"})) {
    set(s, SeriesRole::Other, because(quantity));
  } else if (s.modality == "MR" || s.modality == "CT") {
    set(s, SeriesRole::Anatomical, "plain " + s.modality + " images, no sign of elastography");
  } else {
    set(s, SeriesRole::Other, "modality '" + s.modality + "' and nothing that says what it is for");
  }
}

/// The unit where the file states it, in its scale or in words; else it is asked for.
void setUnitByWords(Series& s) {
  const auto words = unitInWords(s.description);
  if (!words) return;
  if (!s.unit || !mapUnit(*s.unit))
    s.unit = words;
  else if (canonicalUnit(*words) != *s.unit)
    tell(s, DiagnosticCode::UnitsContradict, {{"words", *words}, {"unit", *s.unit}});
}

}  // namespace

std::string name(SeriesRole role) {
  switch (role) {
    case SeriesRole::Anatomical: return "anatomical";
    case SeriesRole::Magnitude: return "magnitude";
    case SeriesRole::Wave: return "wave";
    case SeriesRole::Stiffness: return "stiffness";
    case SeriesRole::Confidence: return "confidence";
    case SeriesRole::ColourCopy: return "colour-copy";
    case SeriesRole::Phase: return "phase";
    case SeriesRole::Other: break;
  }
  return "other";
}

SeriesRole roleNamed(const std::string& text) {
  std::string all;
  for (const SeriesRole role : {SeriesRole::Anatomical, SeriesRole::Magnitude, SeriesRole::Wave, SeriesRole::Stiffness,
                                SeriesRole::Confidence, SeriesRole::ColourCopy, SeriesRole::Phase, SeriesRole::Other}) {
    if (text == name(role)) return role;
    all += (all.empty() ? "" : ", ") + name(role);
  }
  throw BadInput("'" + text.substr(0, 40) + "' is no role of a series; there are " + all);
}

std::vector<std::string> applyRoles(ScanResult& scan, const RoleOverrides& overrides) {
  std::vector<std::string> notFound;
  for (const auto& [which, role] : overrides) {
    bool found = false;
    for (Series& s : scan.series) {
      if (s.uid != which && s.uid.substr(0, s.uid.find('#')) != which && std::to_string(s.number) != which) continue;
      found = true;
      set(s, role, byHand);
    }
    if (!found) notFound.push_back(which);
  }
  return notFound;
}

bool setByHand(const Series& series) {
  return series.roleReason == byHand;
}

void setRoles(std::vector<Series>& volumes) {
  for (Series& s : volumes) {
    const std::string sequence = lowerCase(s.acquired.sequenceName);
    const bool epi = sequence.find("epimre") != std::string::npos;
    if (s.colour) {
      set(s, SeriesRole::ColourCopy, "its pixels are colours, not measured values");
      s.unit.reset();
      if (!s.error)
        s.error = "its pixels are colours: a coloured elastogram is not a stiffness map; load the grey-value series";
      continue;
    }
    if (epi || sequence.find("fgremre") != std::string::npos)
      setGeRole(s, epi ? "epimre" : "fgremre", volumes.size());
    else if (!setVendorRole(s))
      setByDescription(s);
    const bool byCode = s.quantity && !s.diagnostics.contains(DiagnosticCode::QuantityByWords);
    if (byCode && *s.quantity != MapQuantity::Other && s.role != SeriesRole::Stiffness)
      set(s, SeriesRole::Stiffness, "its code says that it holds " + inWords(*s.quantity));
    if (s.role == SeriesRole::Stiffness && !s.quantity && quantityInWords(s.description) == MapQuantity::Other)
      set(s, SeriesRole::Other, "its description says that it holds another quantity than a stiffness");
    if (s.role == SeriesRole::Stiffness) setUnitByWords(s);
    if (s.acquired.privateScale && (s.role == SeriesRole::Stiffness || s.role == SeriesRole::Confidence))
      tell(s, DiagnosticCode::PrivateScaleNotUsed, {{"factor", *s.acquired.privateScale}});
  }
}

const Series& findRole(const ScanResult& scan, SeriesRole role) {
  const Series* best = nullptr;
  std::string there;
  for (const Series& s : scan.series) {
    there += (there.empty() ? "" : ", ") + name(s.role) + " (series " + std::to_string(s.number) + ")";
    if (s.role != role) continue;
    // Set by hand before guessed, readable before unreadable, whole before masked, then more slices; equal ones stay in
    // order of series number and uid.
    const auto rank = [](const Series& x) {
      return std::make_tuple(setByHand(x), !x.error.has_value(), !x.masked, x.grid.size.z());
    };
    if (best == nullptr || rank(s) > rank(*best)) best = &s;
  }
  if (best == nullptr)
    throw BadInput("there is no " + name(role) + " series; " +
                   (there.empty() ? std::string("no image series was found") : "there are: " + there) +
                   ". Name the series by hand if its role was guessed wrongly");
  return *best;
}

}  // namespace glisson::dicom
