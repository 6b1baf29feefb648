// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "dicom/detail/header_wire.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/wire.h"

namespace glisson::dicom::detail {
namespace {

constexpr double farthest_mm = 1e5;

/// A list whose items have an exchange of their own.
template <typename Wire, typename Item, typename Body>
void exchangeList(Wire& w, std::vector<Item>& items, std::size_t most, Body body) {
  auto count = static_cast<std::uint64_t>(items.size());
  w(count);
  if constexpr (!Wire::writes) {
    if (count > most) WireReader::fail();
    items.clear();
  }
  for (std::uint64_t n = 0; n < count; ++n) {
    if constexpr (!Wire::writes) items.emplace_back();
    body(items[n]);
  }
}

template <typename Wire>
void exchange(Wire& w, Origin& o) {
  w(o.patientKey);
  w(o.studyUid);
  w(o.studyDate);
}

template <typename Wire>
void exchange(Wire& w, StructureContour& c) {
  std::vector<double> xyz(c.points_lps_mm.data(), c.points_lps_mm.data() + c.points_lps_mm.size());
  w(xyz);
  w(c.referencedSopInstanceUid);
  w(c.exclusiveOr);
  if constexpr (!Wire::writes) {
    if (xyz.size() % 3 != 0) WireReader::fail();
    c.points_lps_mm = Eigen::Map<const Eigen::Matrix3Xd>(xyz.data(), 3, static_cast<Eigen::Index>(xyz.size() / 3));
  }
}

template <typename Wire>
void exchange(Wire& w, StructureSet& set) {
  // More than any list can hold that the message has room for: the reader fails at its end.
  constexpr std::size_t any = 1ULL << 40;
  exchange(w, set.origin);
  w(set.frameOfReferenceUid);
  w(set.referencedSeriesUid);
  exchangeList(w, set.references, any, [&](ReferencedSeries& r) {
    w(r.frameOfReferenceUid);
    w(r.seriesUid);
  });
  w(set.warnings);
  exchangeList(w, set.structures, any, [&](Structure& s) {
    w(s.number);
    w(s.name);
    w(s.frameOfReferenceUid);
    exchangeList(w, s.contours, any, [&](StructureContour& c) { exchange(w, c); });
  });
}

template <typename Wire>
void exchange(Wire& w, SegHeader& h) {
  exchange(w, h.about.origin);
  w(h.about.frameOfReferenceUid);
  w(h.about.referencedSeriesUid);
  w(h.about.referencedSopInstanceUids);
  w(h.about.warnings);
  exchangeList(w, h.about.segments, maxSegments, [&](Segment& s) {
    w(s.number);
    w(s.label);
    w(s.propertyCode);
  });
  w(h.rows);
  w(h.columns);
  w(h.bits);
  w(h.fractional);
  w(h.labelMap);
  w(h.maximum);
  w(h.row);
  w(h.column);
  w(h.rowSpacing_mm);
  w(h.columnSpacing_mm);
  w(h.sliceSpacing_mm);
  w(h.thickness_mm);
  exchangeList(w, h.frames, maxSegFrames, [&](SegFrame& f) {
    w(f.position_lps_mm);
    w(f.segment);
    w(f.sourceSopInstanceUid);
  });
}

template <typename Object>
std::string written(Object object) {
  WireWriter w;
  exchange(w, object);
  return std::move(w.bytes);
}

template <typename Object>
Object readFrom(const std::string& message) {
  WireReader w(message);
  Object object;
  exchange(w, object);
  w.end();
  return object;
}

void clean(std::string& text) {
  text = shownFrom(std::move(text));
}

void cleanAll(std::vector<std::string>& texts) {
  for (std::string& text : texts) clean(text);
}

void check(Origin& o) {
  if ((!o.patientKey.empty() && o.patientKey.size() != 64) || o.studyDate.size() > 16) WireReader::fail();
  clean(o.studyUid);
}

}  // namespace

std::string toMessage(const StructureSet& set) {
  return written(set);
}

std::string toMessage(const SegHeader& header) {
  return written(header);
}

StructureSet structuresFrom(const std::string& message) {
  auto set = readFrom<StructureSet>(message);
  check(set.origin);
  clean(set.frameOfReferenceUid);
  clean(set.referencedSeriesUid);
  for (ReferencedSeries& r : set.references) {
    clean(r.frameOfReferenceUid);
    clean(r.seriesUid);
  }
  cleanAll(set.warnings);
  for (Structure& s : set.structures) {
    clean(s.name);
    clean(s.frameOfReferenceUid);
    for (StructureContour& c : s.contours) {
      clean(c.referencedSopInstanceUid);
      if (c.points_lps_mm.cols() < 3 || c.points_lps_mm.cwiseAbs().maxCoeff() > farthest_mm) WireReader::fail();
    }
  }
  return set;
}

SegHeader segHeaderFrom(const std::string& message) {
  auto h = readFrom<SegHeader>(message);
  check(h.about.origin);
  clean(h.about.frameOfReferenceUid);
  clean(h.about.referencedSeriesUid);
  cleanAll(h.about.referencedSopInstanceUids);
  cleanAll(h.about.warnings);
  for (Segment& s : h.about.segments) {
    clean(s.label);
    clean(s.propertyCode);
  }
  const auto isUnit = [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1.0) < 1e-3; };
  bool sound = h.rows > 0 && h.rows <= 65535 && h.columns > 0 && h.columns <= 65535;
  sound = sound && (h.labelMap ? h.bits == 8 || h.bits == 16 : h.bits == (h.fractional ? 8 : 1)) && h.maximum > 0 &&
          h.maximum <= 255;
  sound = sound && isUnit(h.row) && isUnit(h.column) && std::abs(h.row.dot(h.column)) < 1e-6;
  sound = sound && h.rowSpacing_mm > 0.0 && h.columnSpacing_mm > 0.0 && !h.frames.empty();
  if (!sound) WireReader::fail();
  for (SegFrame& f : h.frames) {
    clean(f.sourceSopInstanceUid);
    if (f.position_lps_mm.cwiseAbs().maxCoeff() > farthest_mm) WireReader::fail();
  }
  return h;
}

}  // namespace glisson::dicom::detail
