// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/siemens.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "dicom/detail/attributes.h"

namespace glisson::dicom {
namespace {

constexpr const char* useOther = "; export it as single slices or as enhanced multi-frame";

BadInput damaged() {
  return BadInput(std::string("is a Siemens mosaic whose private header (0029,1010) is damaged") + useOther);
}

std::optional<double> toNumber(std::string text) {
  if (!text.empty() && text.front() == '+') text.erase(0, 1);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::map<std::string, std::vector<std::string>> csaOf(DcmDataset& data) {
  for (std::uint16_t block = 0x10; block <= 0x1F; ++block) {
    if (text(data, DcmTagKey(0x0029, block)) != "SIEMENS CSA HEADER") continue;
    DcmElement* element = nullptr;
    Uint8* bytes = nullptr;
    const DcmTagKey tag(0x0029, static_cast<Uint16>((block << 8) | 0x10));
    if (data.findAndGetElement(tag, element).bad() || element == nullptr || element->getUint8Array(bytes).bad() ||
        bytes == nullptr)
      break;
    return csaValues(bytes, element->getLength());
  }
  throw BadInput(
      std::string("is a Siemens mosaic without its private header (0029,1010), so that the number and the order of its "
                  "slices are unknown") +
      useOther);
}

}  // namespace

std::map<std::string, std::vector<std::string>> csaValues(const std::uint8_t* bytes, std::size_t count) {
  constexpr std::size_t entryBytes = 84;  // name 64, multiplicity 4, representation 4, type 4, items 4, marker 4
  std::size_t at = 16;
  const auto number = [&](std::size_t where) {
    std::int32_t value;
    if (where > count || count - where < 4) throw damaged();
    std::memcpy(&value, bytes + where, 4);
    return value;
  };
  if (count < 16 || std::memcmp(bytes, "SV10", 4) != 0) throw damaged();
  const std::int32_t entries = number(8);
  if (entries < 1 || entries > 1024) throw damaged();
  const auto textAt = [&](std::size_t where, std::size_t most) {
    const auto* begin = reinterpret_cast<const char*>(bytes + where);
    std::string value(begin, std::find(begin, begin + most, '\0'));
    while (!value.empty() && value.back() == ' ') value.pop_back();
    value.erase(0, std::min(value.find_first_not_of(' '), value.size()));
    return value;
  };
  std::map<std::string, std::vector<std::string>> all;
  for (std::int32_t n = 0; n < entries; ++n) {
    if (count - at < entryBytes) throw damaged();
    std::vector<std::string>& values = all[textAt(at, 64)];
    const std::int32_t items = number(at + 76);
    if (items < 0 || items > 65536) throw damaged();
    at += entryBytes;
    for (std::int32_t i = 0; i < items; ++i) {
      const std::int32_t length = number(at + 4);
      if (count - at < 16 || length < 0) throw damaged();
      at += 16;
      if (count - at < static_cast<std::size_t>(length)) throw damaged();
      std::string value = textAt(at, static_cast<std::size_t>(length));
      if (!value.empty()) values.push_back(std::move(value));
      at += std::min(count - at, (static_cast<std::size_t>(length) + 3) / 4 * 4);
    }
  }
  return all;
}

void expandMosaic(DcmDataset& data, ImageHeader& h) {
  const auto csa = csaOf(data);
  const auto values = [&csa](const char* name) {
    std::vector<double> out;
    const auto found = csa.find(name);
    if (found == csa.end()) return out;
    for (const std::string& text : found->second) {
      const auto value = toNumber(text);
      if (!value) throw damaged();
      out.push_back(*value);
    }
    return out;
  };
  const std::vector<double> count = values("NumberOfImagesInMosaic");
  const std::vector<double> direction = values("SliceNormalVector");
  if (count.size() != 1 || count[0] < 1.0 || count[0] > 65536.0 || count[0] != std::floor(count[0]))
    throw BadInput(std::string("is a Siemens mosaic that does not say how many slices it holds (0029,1010)") +
                   useOther);
  const auto slices = static_cast<int>(count[0]);
  const int perRow = static_cast<int>(std::ceil(std::sqrt(count[0])));
  if (h.rows % perRow != 0 || h.columns % perRow != 0)
    throw BadInput("is a Siemens mosaic of " + std::to_string(slices) + " slices, but its " +
                   std::to_string(h.columns) + " x " + std::to_string(h.rows) + " pixels are no " +
                   std::to_string(perRow) + " x " + std::to_string(perRow) + " tiles of one size");
  const Frame whole = h.frames.front();
  if (!whole.statedSpacing_mm)
    throw BadInput("is a Siemens mosaic without " + nameOf(DCM_SpacingBetweenSlices) +
                   ", so that the place of its slices is unknown");
  const Eigen::Vector3d normal = whole.row.cross(whole.column);
  if (direction.size() != 3)
    throw BadInput(
        std::string("is a Siemens mosaic without the direction of its slices (SliceNormalVector, 0029,1010)") +
        useOther);
  const double along = Eigen::Vector3d(direction[0], direction[1], direction[2]).dot(normal);
  if (std::abs(std::abs(along) - 1.0) > 1e-3)
    throw BadInput("is a Siemens mosaic whose slices do not lie along their normal (SliceNormalVector, 0029,1010)");
  h.tile = {h.rows / perRow, h.columns / perRow, perRow};
  const Eigen::Vector3d first = whole.position_lps_mm +
                                0.5 * (h.columns - h.tile.columns) * whole.columnSpacing_mm * whole.row +
                                0.5 * (h.rows - h.tile.rows) * whole.rowSpacing_mm * whole.column;
  h.frames.clear();
  for (int n = 0; n < slices; ++n) {
    Frame f = whole;
    f.number = n;
    f.position_lps_mm = first + n * *whole.statedSpacing_mm * (along > 0.0 ? normal : Eigen::Vector3d(-normal));
    h.frames.push_back(std::move(f));
  }
}

ElastographyStep elastographyStep(const std::string& comment) {
  ElastographyStep step;
  if (!comment.starts_with("MRE:")) return step;
  const auto value = [&comment](const std::string& key) -> std::optional<double> {
    const std::size_t at = comment.find(key + "[");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + key.size() + 1;
    const std::size_t end = comment.find(']', begin);
    if (end == std::string::npos) return {};
    return toNumber(comment.substr(begin, end - begin));
  };
  const auto index = [&value](const char* key) {
    const auto v = value(key);
    return v && *v >= 0.0 && *v < 10000.0 && *v == std::floor(*v) ? static_cast<int>(*v) : -1;
  };
  step.frequency = index("fI");
  step.direction = index("dI");
  step.time = index("tI");
  const auto period_us = value("VP");
  if (period_us && *period_us > 100.0 && *period_us < 1e8) step.vibration_Hz = 1e6 / *period_us;
  return step;
}

}  // namespace glisson::dicom
