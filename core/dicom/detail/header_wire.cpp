// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/header_wire.h"

#include <algorithm>

#include "dicom/detail/wire.h"

namespace glisson::dicom::detail {
namespace {

template <typename Wire>
void exchange(Wire& w, Rescale& r) {
  w(r.slope);
  w(r.intercept);
}

template <typename Wire>
void exchange(Wire& w, Frame& f) {
  w(f.number);
  w(f.position_lps_mm);
  w(f.row);
  w(f.column);
  w(f.rowSpacing_mm);
  w(f.columnSpacing_mm);
  w(f.thickness_mm);
  w(f.statedSpacing_mm);
  exchange(w, f.rescale);
  w(f.map);
  w(f.scaleDoubt);
  w(f.unit);
  w(f.quantity);
  w(f.kinds);
}

template <typename Wire>
void exchange(Wire& w, ValueSegment& s) {
  w(s.first);
  w(s.last);
  exchange(w, s.line);
  w(s.table);
}

template <typename Wire>
void exchange(Wire& w, ValueMap& map);

template <typename Wire, typename Item>
void exchangeAll(Wire& w, std::vector<Item>& items) {
  auto count = static_cast<std::uint32_t>(items.size());
  w(count);
  if constexpr (!Wire::writes) items.clear();
  for (std::uint32_t n = 0; n < count; ++n) {
    if constexpr (!Wire::writes) items.emplace_back();
    exchange(w, items[n]);
  }
}

template <typename Wire>
void exchange(Wire& w, ValueMap& map) {
  exchangeAll(w, map);
}

template <typename Wire>
void exchange(Wire& w, ImageHeader& h) {
  w(h.layout.transferSyntax);
  for (std::string* text :
       {&h.seriesUid, &h.studyUid, &h.frameOfReferenceUid, &h.sopInstanceUid, &h.sopClassUid, &h.patientKey,
        &h.studyDate, &h.modality, &h.description, &h.imageType, &h.manufacturer, &h.sequenceName, &h.acquisitionUid})
    w(*text);
  w(h.acquisitionNumber);
  w(h.acquisition_s);
  w(h.references);
  exchangeAll(w, h.maps);
  w(h.padding);
  w(h.privateScale);
  w(h.seriesNumber);
  w(h.instanceNumber);
  w(h.rows);
  w(h.columns);
  w(h.samples);
  w(h.bitsAllocated);
  w(h.bitsStored);
  w(h.isSigned);
  w(h.palette);
  w(h.lossy);
  w(h.burnedIn);
  w(h.kind);
  w(h.tile.rows);
  w(h.tile.columns);
  w(h.tile.perRow);
  w(h.step.direction);
  w(h.step.time);
  w(h.step.frequency);
  w(h.step.vibration_Hz);
  w(h.announced.images);
  w(h.announced.slices);
  w(h.announced.concatenationUid);
  w(h.announced.part);
  w(h.announced.parts);
  exchangeAll(w, h.frames);
  w(h.warnings);
}

bool isUid(const std::string& text) {
  return text.size() <= 64 && text.find_first_not_of("0123456789.") == std::string::npos;
}

bool isUnit(const Eigen::Vector3d& v) {
  return std::abs(v.norm() - 1.0) < 1e-3;
}

void check(const ImageHeader& h, std::uint64_t fileBytes) {
  bool sound = isUid(h.seriesUid) && !h.seriesUid.empty() && isUid(h.sopInstanceUid) &&
               (h.patientKey.empty() || h.patientKey.size() == 64) && h.studyDate.size() <= 16;
  sound = sound && h.rows > 0 && h.rows <= 65535 && h.columns > 0 && h.columns <= 65535;
  sound = sound && (h.samples == 1 || h.samples == 3) && h.bitsStored > 0 && h.bitsStored <= h.bitsAllocated;
  const bool bits = h.kind == PixelKind::Integer
                        ? h.bitsAllocated == 8 || h.bitsAllocated == 16 || h.bitsAllocated == 32
                        : (h.kind == PixelKind::Float && h.bitsAllocated == 32) ||
                              (h.kind == PixelKind::Double && h.bitsAllocated == 64);
  sound = sound && bits && !h.frames.empty();
  if (!sound) WireReader::fail();
  const std::uint64_t pictures = h.isMosaic() ? 1 : h.frames.size();
  if (pictures > memoryBudget(fileBytes) / h.frameBytes()) WireReader::fail();
  if (h.isMosaic()) {
    const MosaicTile& t = h.tile;
    const auto most = static_cast<std::size_t>(t.perRow) * static_cast<std::size_t>(t.perRow);
    if (t.rows <= 0 || t.columns <= 0 || t.perRow <= 0 || t.perRow > 256 || t.rows > h.rows / t.perRow ||
        t.columns > h.columns / t.perRow || h.frames.size() > most)
      WireReader::fail();
  }
  for (const ValueMap& map : h.maps)
    for (const ValueSegment& segment : map)
      if (map.empty() ||
          (!segment.table.empty() && segment.last - segment.first + 1.0 != static_cast<double>(segment.table.size())))
        WireReader::fail();
  for (std::size_t n = 0; n < h.frames.size(); ++n) {
    const Frame& f = h.frames[n];
    if (f.number != static_cast<int>(n) || !isUnit(f.row) || !isUnit(f.column) || f.rowSpacing_mm <= 0.0 ||
        f.columnSpacing_mm <= 0.0 || f.map < -1 || f.map >= static_cast<int>(h.maps.size()) ||
        f.scaleDoubt > ScaleDoubt::TableUnread ||
        std::any_of(f.kinds.begin(), f.kinds.end(),
                    [](const auto& kind) { return kind.first > FrameKind::WordsAboutValues; }) ||
        f.quantity.value_or(MapQuantity::Other) > MapQuantity::Other)
      WireReader::fail();
  }
}

}  // namespace

std::string shownFrom(std::string text) {
  std::string out;
  for (const char c : text)
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F && out.size() < 600) out += c;
  return out;
}

std::string toMessage(ImageHeader header) {
  WireWriter w;
  exchange(w, header);
  return std::move(w.bytes);
}

ImageHeader headerFrom(const std::string& message, std::uint64_t fileBytes) {
  WireReader w(message);
  ImageHeader h;
  exchange(w, h);
  w.end();
  check(h, fileBytes);
  for (std::string* text : {&h.layout.transferSyntax, &h.studyUid, &h.frameOfReferenceUid, &h.sopClassUid, &h.modality,
                            &h.description, &h.imageType, &h.manufacturer, &h.sequenceName, &h.acquisitionUid})
    *text = shownFrom(std::move(*text));
  h.announced.concatenationUid = shownFrom(std::move(h.announced.concatenationUid));
  for (std::vector<std::string>* texts : {&h.warnings, &h.references})
    for (std::string& text : *texts) text = shownFrom(std::move(text));
  for (Frame& f : h.frames) f.unit = shownFrom(std::move(f.unit));
  return h;
}

}  // namespace glisson::dicom::detail
