#include "dicom/roles.h"

#include <algorithm>
#include <initializer_list>
#include <tuple>

#include "base/error.h"
#include "base/text.h"

namespace glisson::dicom {
namespace {

const char* firstOf(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (text.find(word) != std::string::npos) return word;
  return nullptr;
}

constexpr const char* byHand = "set by hand";

void set(Series& s, SeriesRole role, const std::string& reason) {
  s.role = role;
  s.roleReason = reason;
}

/// GE numbers the products of one MRE acquisition N: 100 N + 1 stiffness, + 5 wave, + 7 confidence.
void setGeRole(Series& s, const ImageHeader& h, const std::string& sequence, std::size_t phases) {
  const int product = s.number >= 100 ? s.number % 100 : 0;
  const std::string where = "GE sequence '" + sequence + "', series number " + std::to_string(s.number);
  const bool echoPlanar = sequence.find("epimre") != std::string::npos;
  if (product == 1) {
    set(s, SeriesRole::Stiffness, where + " (ends in 01: stiffness in Pa)");
    s.unit = "Pa";
  } else if (product == 5) {
    set(s, SeriesRole::Wave, where + " (ends in 05: processed wave image)");
  } else if (product == 7 && !echoPlanar && phases > 1) {
    set(s, SeriesRole::Wave,
        where + " (ends in 07 with " + std::to_string(phases) + " phases: wave on the gradient-echo sequence)");
  } else if (product == 7) {
    set(s, SeriesRole::Confidence, where + " (ends in 07: confidence 0 to 999)");
  } else if (product != 0) {
    set(s, SeriesRole::Other, where + " (no product that is used)");
  } else {
    const auto& kinds = h.frames.front().kinds;
    const bool phase = std::any_of(kinds.begin(), kinds.end(),
                                   [](const auto& k) { return k.first == "private image type" && k.second != "0"; });
    if (phase && phases == 1) {
      set(s, SeriesRole::Phase, where + " (raw phase images)");
    } else {
      set(s, SeriesRole::Magnitude, where + " (the acquisition itself: magnitude)");
    }
  }
}

/// What the words of a name mean on scanners that name the products of an elastography acquisition.
struct ProductName {
  const char* word;
  SeriesRole role;
  const char* meaning;
};

/// Siemens ("MR Elastography": products by the end of the series description or a part of the image type) and Philips
/// ("MRE": products by image type). Both write maps of the same words; nothing is taken from private scale factors.
/// True where one applies.
bool setVendorRole(Series& s, const ImageHeader& h) {
  const std::string maker = lowerCase(h.manufacturer);
  const char* vendor = maker.find("siemens") != std::string::npos   ? "Siemens"
                       : maker.find("philips") != std::string::npos ? "Philips"
                                                                    : nullptr;
  if (vendor == nullptr) return false;
  const std::string description = lowerCase(s.description);
  const std::string type = lowerCase(h.imageType);
  const std::string sequence = lowerCase(h.sequenceName);
  if (firstOf(description + "\\" + type + "\\" + sequence, {"mre", "elasto", "stiff"}) == nullptr && h.step.time < 0)
    return false;
  static constexpr ProductName products[] = {
      {"confmap", SeriesRole::Confidence, "confidence map"},    {"conf_map", SeriesRole::Confidence, "confidence map"},
      {"confidence", SeriesRole::Confidence, "confidence map"}, {"stiffness", SeriesRole::Stiffness, "stiffness map"},
      {"stiff", SeriesRole::Stiffness, "stiffness map"},        {"elastogram", SeriesRole::Stiffness, "stiffness map"},
      {"shear", SeriesRole::Stiffness, "stiffness map"},        {"wave", SeriesRole::Wave, "wave images"},
      {"displacement", SeriesRole::Wave, "wave images"}};
  for (const ProductName& p : products) {
    const bool inType = type.find(p.word) != std::string::npos;
    if (!inType && description.find(p.word) == std::string::npos) continue;
    set(s, p.role,
        std::string(vendor) + " elastography, " + (inType ? "image type" : "series description") + " holds '" + p.word +
            "': " + p.meaning);
    // The unit is taken where the file states it, in its rescale type or in words; else it is asked for.
    if (p.role == SeriesRole::Stiffness && !s.unit) {
      if (description.find("kpa") != std::string::npos)
        s.unit = "kPa";
      else if (description.find("(pa)") != std::string::npos || description.find("[pa]") != std::string::npos)
        s.unit = "Pa";
    }
    return true;
  }
  const bool phase =
      type.find("\\p\\") != std::string::npos || type.ends_with("\\p") || type.find("phase") != std::string::npos;
  const bool magnitude =
      type.find("\\m\\") != std::string::npos || type.ends_with("\\m") || type.find("magnitude") != std::string::npos;
  if (!phase && !magnitude) return false;
  set(s, phase ? SeriesRole::Phase : SeriesRole::Magnitude,
      std::string(vendor) + " elastography, image type '" + h.imageType.substr(0, 40) +
          "': " + (phase ? "raw phase images" : "magnitude"));
  return true;
}

void setByDescription(Series& s, const ImageHeader& h) {
  const std::string description = lowerCase(s.description);
  const std::string type = lowerCase(h.imageType);
  const std::string all = description + "\\" + type;
  const auto because = [&](const char* word) {
    return std::string(description.find(word) != std::string::npos ? "series description" : "image type") + " holds '" +
           word + "'";
  };
  const bool derivedMre = firstOf(all, {"mre", "elasto", "shear", "stiff", "mr touch", "mrtouch"}) != nullptr;
  if (const char* word = firstOf(all, {"confidence", "conf_map", "conf map", "95conf"})) {
    set(s, SeriesRole::Confidence, because(word));
  } else if (const char* stiff = firstOf(all, {"stiff", "elastogram", "shear mod", "shear_mod"})) {
    set(s, SeriesRole::Stiffness, because(stiff));
  } else if (const char* wave = firstOf(all, {"wave"})) {
    set(s, SeriesRole::Wave, because(wave));
  } else if (derivedMre && (type.find("\\p\\") != std::string::npos || firstOf(description, {"phase"}) != nullptr)) {
    set(s, SeriesRole::Phase, "raw phase images of an elastography series");
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

}  // namespace

std::string name(SeriesRole role) {
  switch (role) {
    case SeriesRole::Anatomical:
      return "anatomical";
    case SeriesRole::Magnitude:
      return "magnitude";
    case SeriesRole::Wave:
      return "wave";
    case SeriesRole::Stiffness:
      return "stiffness";
    case SeriesRole::Confidence:
      return "confidence";
    case SeriesRole::ColourCopy:
      return "colour-copy";
    case SeriesRole::Phase:
      return "phase";
    case SeriesRole::Other:
      break;
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

void setRoles(std::vector<Series>& volumes, const ImageHeader& header) {
  const std::string sequence = lowerCase(header.sequenceName);
  const bool geMre = sequence.find("epimre") != std::string::npos || sequence.find("fgremre") != std::string::npos;
  for (Series& s : volumes) {
    if (s.colour) {
      set(s, SeriesRole::ColourCopy, "its pixels are colours, not measured values");
      s.unit.reset();
      if (!s.error)
        s.error = "its pixels are colours: a coloured elastogram is not a stiffness map; load the grey-value series";
    } else if (geMre) {
      setGeRole(s, header, sequence.find("epimre") != std::string::npos ? "epimre" : "fgremre", volumes.size());
    } else if (!setVendorRole(s, header)) {
      setByDescription(s, header);
    }
  }
}

const Series& findRole(const ScanResult& scan, SeriesRole role) {
  const Series* best = nullptr;
  std::string there;
  for (const Series& s : scan.series) {
    there += (there.empty() ? "" : ", ") + name(s.role) + " (series " + std::to_string(s.number) + ")";
    if (s.role != role) continue;
    // Set by hand before guessed, readable before unreadable, then more slices; equal ones stay in order of series
    // number and uid.
    const auto rank = [](const Series& x) {
      return std::make_tuple(x.roleReason == byHand, !x.error.has_value(), x.grid.size.z());
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
