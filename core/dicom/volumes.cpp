// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/volumes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <tuple>

#include "base/diagnostic.h"
#include "base/error.h"
#include "dicom/detail/announced.h"
#include "dicom/detail/planes.h"
#include "dicom/detail/series_facts.h"
#include "dicom/detail/stored_frames.h"

namespace glisson::dicom {
namespace {

using detail::nameOf;
using detail::namesOf;
using detail::Plane;
using detail::Planes;
using detail::samePlace_mm;

/// Parts the planes into those that agree with the first and the others; an error names both.
template <typename Same>
std::optional<std::string> mixed(const Planes& planes, const char* what, Same same) {
  Planes with;
  Planes without;
  for (const Plane& p : planes) (same(planes.front(), p) ? with : without).push_back(p);
  if (without.empty()) return {};
  return std::string("its images differ in ") + what + ": " + namesOf(with) + " against " + namesOf(without) +
         "; a volume cannot be made of them";
}

std::optional<std::string> mixture(const Planes& planes) {
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm() < 1e-3; };
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-3 * std::max(a, b); };
  if (auto e = mixed(planes, "orientation", [&](const Plane& a, const Plane& b) {
        return near(a.frame->row, b.frame->row) && near(a.frame->column, b.frame->column);
      }))
    return e;
  if (auto e = mixed(planes, "size (rows, columns)", [](const Plane& a, const Plane& b) {
        return a.header->sliceRows() == b.header->sliceRows() && a.header->sliceColumns() == b.header->sliceColumns();
      }))
    return e;
  if (auto e = mixed(planes, "kind (mosaics and single slices)",
                     [](const Plane& a, const Plane& b) { return a.header->isMosaic() == b.header->isMosaic(); }))
    return e;
  if (auto e = mixed(planes, "pixel spacing", [&](const Plane& a, const Plane& b) {
        return close(a.frame->rowSpacing_mm, b.frame->rowSpacing_mm) &&
               close(a.frame->columnSpacing_mm, b.frame->columnSpacing_mm);
      }))
    return e;
  if (auto e = mixed(planes, "frame of reference", [](const Plane& a, const Plane& b) {
        return a.header->frameOfReferenceUid == b.header->frameOfReferenceUid;
      }))
    return e;
  if (auto e = mixed(planes, "patient",
                     [](const Plane& a, const Plane& b) { return a.header->patientKey == b.header->patientKey; }))
    return e;
  return mixed(planes, "kind of pixels (colour or grey)",
               [](const Plane& a, const Plane& b) { return a.header->colour() == b.header->colour(); });
}

bool hasDuplicates(Planes planes) {
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.along_mm < b.along_mm; });
  for (std::size_t n = 1; n < planes.size(); ++n)
    if (planes[n].along_mm - planes[n - 1].along_mm < samePlace_mm) return true;
  return false;
}

std::size_t distinctPositions(Planes planes) {
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.along_mm < b.along_mm; });
  std::size_t count = planes.empty() ? 0 : 1;
  for (std::size_t n = 1; n < planes.size(); ++n)
    if (planes[n].along_mm - planes[n - 1].along_mm >= samePlace_mm) ++count;
  return count;
}

/// Numbers by value, the rest as text, so that "10" comes after "9".
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    double x = 0.0;
    double y = 0.0;
    const bool isX = std::from_chars(a.data(), a.data() + a.size(), x).ptr == a.data() + a.size() && !a.empty();
    const bool isY = std::from_chars(b.data(), b.data() + b.size(), y).ptr == b.data() + b.size() && !b.empty();
    if (isX && isY) return x != y ? x < y : a < b;
    return isX != isY ? isX : a < b;
  }
};

struct Part {
  Planes planes;
  std::string told;  ///< what tells it from its siblings, e.g. "echo time 4.6"
  int time = -1;     ///< its rank, where a time or an order of acquisition tells it from its siblings
};

/// Whether every file is a volume of its own: mosaics; multi-frame files that cover the same places.
bool eachFileIsAVolume(const Planes& planes) {
  std::map<const ImageHeader*, std::vector<double>> places;
  for (const Plane& p : planes) {
    if (!p.header->isMosaic() && p.header->frames.size() < 2) return false;
    places[p.header].push_back(p.along_mm);
  }
  if (places.size() < 2) return false;
  for (auto& [header, list] : places) std::sort(list.begin(), list.end());
  const std::vector<double>& first = places.begin()->second;
  return std::all_of(places.begin(), places.end(), [&](const auto& file) {
    return std::equal(first.begin(), first.end(), file.second.begin(), file.second.end(),
                      [](double a, double b) { return std::abs(a - b) < samePlace_mm; });
  });
}

/// One part per file: in order of the steps of an elastography acquisition where the files name them, else of instance
/// numbers.
std::vector<Part> partsPerFile(const Planes& planes) {
  const auto order = [](const ImageHeader* h) {
    return std::make_tuple(h->step.frequency, h->step.direction, h->step.time, h->instanceNumber, h->file);
  };
  const auto before = [&order](const ImageHeader* a, const ImageHeader* b) { return order(a) < order(b); };
  std::map<const ImageHeader*, Planes, decltype(before)> byFile(before);
  for (const Plane& p : planes) byFile[p.header].push_back(p);
  std::vector<Part> parts;
  for (auto& [h, own] : byFile) {
    Part part{std::move(own), "instance number " + std::to_string(h->instanceNumber), h->step.time};
    if (h->step.time >= 0)
      part.told = (h->step.direction >= 0 ? "encoding direction " + std::to_string(h->step.direction + 1) + ", " : "") +
                  std::string("time step ") + std::to_string(h->step.time + 1);
    else
      part.time = static_cast<int>(parts.size());
    parts.push_back(std::move(part));
  }
  return parts;
}

/// What splits a series, strongest first, in words.
constexpr std::pair<FrameKind, const char*> kindNames[] = {
    {FrameKind::ImageType, "image type"},
    {FrameKind::ComplexComponent, "complex component"},
    {FrameKind::PrivateImageType, "private image type"},
    {FrameKind::Quantity, "quantity"},
    {FrameKind::EchoNumber, "echo number"},
    {FrameKind::EchoTime, "echo time"},
    {FrameKind::InversionTime, "inversion time"},
    {FrameKind::DiffusionBValue, "diffusion b-value"},
    {FrameKind::TemporalPosition, "temporal position"},
    {FrameKind::TriggerTime, "trigger time"},
    {FrameKind::AcquisitionNumber, "acquisition number"},
    {FrameKind::TriggerDelay, "trigger delay"},
    {FrameKind::FrameAcquisitionNumber, "frame acquisition number"},
    {FrameKind::TimeIndex, "time index"},
    {FrameKind::DimensionIndex1, "dimension index 1"},
    {FrameKind::DimensionIndex2, "dimension index 2"},
    {FrameKind::DimensionIndex3, "dimension index 3"},
    {FrameKind::DimensionIndex4, "dimension index 4"},
    {FrameKind::DimensionIndex5, "dimension index 5"}};

/// Parts planes that share positions by the first attribute that explains it; again within each part.
void split(Part part, std::vector<Part>& out) {
  if (!hasDuplicates(part.planes)) {
    out.push_back(std::move(part));
    return;
  }
  for (const auto& [kind, name] : kindNames) {
    std::map<std::string, Planes, NaturalOrder> byValue;
    for (const Plane& p : part.planes) {
      std::string value;
      for (const auto& [what, text] : p.frame->kinds)
        if (what == kind) value = text;
      byValue[value].push_back(p);
    }
    if (byValue.size() < 2) continue;
    // Images of one kind cover the same places; times and numbers that merely count the slices up explain nothing.
    const std::size_t places = distinctPositions(byValue.begin()->second);
    bool sound = true;
    for (const auto& [value, planes] : byValue) {
      const std::size_t here = distinctPositions(planes);
      if (kind != FrameKind::ImageType && kind != FrameKind::PrivateImageType && here != places) sound = false;
      if ((kind == FrameKind::TriggerTime || kind == FrameKind::AcquisitionNumber) && here < 2) sound = false;
    }
    if (!sound) continue;
    const bool inTime = kind == FrameKind::TemporalPosition || kind == FrameKind::TriggerTime ||
                        kind == FrameKind::AcquisitionNumber || kind == FrameKind::TriggerDelay ||
                        kind == FrameKind::TimeIndex;
    int rank = 0;
    for (auto& [value, planes] : byValue) {
      split({std::move(planes), part.told + (part.told.empty() ? "" : ", ") + name + " " + value.substr(0, 40),
             inTime ? rank : part.time},
            out);
      ++rank;
    }
    return;
  }
  out.push_back(std::move(part));
}

Series describe(const ImageHeader& h) {
  Series s;
  s.uid = h.seriesUid;
  s.studyUid = h.studyUid;
  s.frameOfReferenceUid = h.frameOfReferenceUid;
  s.patientKey = h.patientKey;
  s.modality = h.modality;
  s.description = h.description;
  s.number = h.seriesNumber;
  s.sopClassUid = h.sopClassUid;
  s.colour = h.colour();
  s.studyDate = h.studyDate;
  s.grid.size = {h.sliceColumns(), h.sliceRows(), 1};
  if (h.frameOfReferenceUid.empty())
    s.warnings.push_back("has no frame of reference: how it lies to others is unknown");
  return s;
}

void addFiles(const Planes& planes, Series& series) {
  const bool multi = planes.front().header->frames.size() > 1 || planes.front().header->isMosaic();
  for (const Plane& p : planes) {
    auto known = series.files.end();
    if (multi) {
      series.frames.push_back(p.frame->number);
      known = std::find(series.files.begin(), series.files.end(), p.header->file);
      series.fileOfSlice.push_back(static_cast<int>(known - series.files.begin()));
    }
    if (known != series.files.end()) continue;
    series.files.push_back(p.header->file);
    series.sopInstanceUids.push_back(p.header->sopInstanceUid);
  }
  if (series.files.size() == 1) series.fileOfSlice.clear();
  std::map<std::string, Planes> warned;
  for (const Plane& p : planes)
    if (&p.header->frames.front() == p.frame || planes.size() == 1) {
      series.lossy = series.lossy || p.header->lossy;
      series.burnedIn = series.burnedIn || p.header->burnedIn;
      for (const std::string& w : p.header->warnings) warned[w].push_back(p);
    }
  for (const auto& [text, where] : warned)
    series.warnings.push_back((where.size() == planes.size() ? std::string("every file") : namesOf(where)) + " " +
                              text);
}

Series volumeOf(Planes planes, const Eigen::Vector3d& normal) {
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Plane& a, const Plane& b) { return a.along_mm < b.along_mm; });
  const ImageHeader& h = *planes.front().header;
  const Frame& first = *planes.front().frame;
  Series s = describe(h);
  addFiles(planes, s);
  std::vector<SliceFacts> facts;
  for (const Plane& p : planes) facts.push_back({p.header, p.frame});
  takeFacts(facts, s);
  s.grid.size.z() = static_cast<int>(planes.size());
  s.grid.spacing_mm = {first.columnSpacing_mm, first.rowSpacing_mm, 1.0};
  s.grid.origin_lps_mm = first.position_lps_mm;
  s.grid.direction.col(0) = first.row;
  s.grid.direction.col(1) = first.column;
  s.grid.direction.col(2) = normal;
  for (const Plane& p : planes)
    if (const auto why = undecodable(p.header->layout.transferSyntax)) s.error = nameOf(p) + ": " + *why;
  for (const Plane& p : planes)
    if (!p.header->contradicted.empty() && !s.error)
      s.error =
          nameOf(p) + " and '" + p.header->contradicted.filename().string() +
          "' are one image by their SOP instance and position, but hold different pixels; which of the two is meant "
          "is not known: remove the other one";
  if (s.error) return s;
  for (const Plane& p : planes)
    if (planes.front().header->frames.size() > 1 && p.header != planes.front().header &&
        (h.announced.concatenationUid.empty() ||
         p.header->announced.concatenationUid != h.announced.concatenationUid)) {
      s.error =
          "it spreads over several multi-frame files: " + namesOf({planes.front(), p}) + "; load one of them alone";
      return s;
    }
  detail::spaceSlices(planes, normal, s);
  if (s.error) return s;
  try {
    s.grid.check();
  } catch (const BadInput& e) {
    s.error = e.what();
  }
  return s;
}

}  // namespace

std::vector<Series> buildVolumes(const std::vector<ImageHeader>& headers) {
  Planes planes;
  for (const ImageHeader& h : headers)
    for (const Frame& f : h.frames) planes.push_back({&h, &f, 0.0});
  if (const auto why = mixture(planes)) {
    Series s = describe(*planes.front().header);
    addFiles(planes, s);
    takeFacts({{planes.front().header, planes.front().frame}}, s);
    s.grid.size.z() = static_cast<int>(planes.size());
    s.error = *why;
    return {s};
  }
  const Eigen::Vector3d normal = planes.front().frame->row.cross(planes.front().frame->column).normalized();
  for (Plane& p : planes) p.along_mm = p.frame->position_lps_mm.dot(normal);
  std::vector<Part> parts;
  if (eachFileIsAVolume(planes))
    parts = partsPerFile(planes);
  else
    split({planes, {}}, parts);
  std::vector<Series> out;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    Series s = volumeOf(parts[n].planes, normal);
    s.temporalIndex = parts[n].time;
    const ElastographyStep& step = parts[n].planes.front().header->step;
    s.encodingDirection = step.direction;
    if (step.time >= 0) s.temporalIndex = step.time;
    if (step.vibration_Hz > 0.0) s.vibration_Hz = step.vibration_Hz;
    if (parts.size() > 1) {
      if (n > 0) s.uid += "#" + std::to_string(n + 1);
      tell(s, DiagnosticCode::VolumeOfSeries,
           {{"volume", static_cast<std::int64_t>(n + 1)},
            {"volumes", static_cast<std::int64_t>(parts.size())},
            {"told", parts[n].told}});
    }
    out.push_back(std::move(s));
  }
  std::map<std::string, std::vector<const ImageHeader*>> cut;
  for (const ImageHeader& h : headers)
    if (!h.announced.concatenationUid.empty()) cut[h.announced.concatenationUid].push_back(&h);
  for (const auto& [uid, pieces] : cut)
    if (const std::string why = missingParts(pieces); !why.empty())
      for (Series& s : out)
        if (!s.error || !s.unevenSlices_mm.empty()) {
          s.error = why;
          s.unevenSlices_mm.clear();
        }
  return out;
}

}  // namespace glisson::dicom
