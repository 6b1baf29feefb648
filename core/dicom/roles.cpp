#include "dicom/roles.h"

#include <algorithm>
#include <initializer_list>

#include "base/error.h"

namespace glisson::dicom {
namespace {

std::string lower(std::string s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return s;
}

const char* firstOf(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (text.find(word) != std::string::npos) return word;
  return nullptr;
}

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
      set(s, SeriesRole::Other, where + " (raw phase images)");
    } else {
      set(s, SeriesRole::Magnitude, where + " (the acquisition itself: magnitude)");
    }
  }
}

void setByDescription(Series& s, const ImageHeader& h) {
  const std::string description = lower(s.description);
  const std::string type = lower(h.imageType);
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
    set(s, SeriesRole::Other, "raw phase images of an elastography series");
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
    case SeriesRole::Other:
      break;
  }
  return "other";
}

void setRoles(std::vector<Series>& volumes, const ImageHeader& header) {
  const std::string sequence = lower(header.sequenceName);
  const bool geMre = sequence.find("epimre") != std::string::npos || sequence.find("fgremre") != std::string::npos;
  for (Series& s : volumes) {
    if (s.colour) {
      set(s, SeriesRole::ColourCopy, "its pixels are colours, not measured values");
      s.unit.reset();
      if (!s.error)
        s.error = "its pixels are colours: a coloured elastogram is not a stiffness map; load the grey-value series";
    } else if (geMre) {
      setGeRole(s, header, sequence.find("epimre") != std::string::npos ? "epimre" : "fgremre", volumes.size());
    } else {
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
    // Readable before unreadable, then more slices; equal ones stay in order of series number and uid.
    if (best == nullptr || (best->error && !s.error) ||
        (best->error.has_value() == s.error.has_value() && s.grid.size.z() > best->grid.size.z()))
      best = &s;
  }
  if (best == nullptr)
    throw BadInput("there is no " + name(role) + " series; " +
                   (there.empty() ? std::string("no image series was found") : "there are: " + there) +
                   ". Name the series by hand if its role was guessed wrongly");
  return *best;
}

}  // namespace glisson::dicom
