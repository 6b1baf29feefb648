// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/naming.h"
#include "dicom/detail/packed_frames.h"
#include "dicom/detail/parsed_objects.h"
#include "dicom/detail/reader_process.h"
#include "dicom/detail/slice_stack.h"
#include "dicom/seg.h"

namespace glisson::dicom {
namespace {

using detail::SegFrame;
using detail::SegHeader;

constexpr double positionTolerance_mm = 0.01;

/// One lattice for all frames: ordered along the normal, a whole number of steps apart.
image::Grid latticeOf(const SegHeader& h, std::vector<int>& sliceOfFrame) {
  const Eigen::Vector3d normal = h.row.cross(h.column);
  std::vector<double> at;
  for (const SegFrame& f : h.frames) at.push_back(normal.dot(f.position_lps_mm));
  std::vector<double> levels = at;
  std::sort(levels.begin(), levels.end());
  levels.erase(
      std::unique(levels.begin(), levels.end(), [](double a, double b) { return b - a < positionTolerance_mm; }),
      levels.end());
  double step = h.sliceSpacing_mm.value_or(0.0) > 0.0 ? *h.sliceSpacing_mm
                : h.thickness_mm.value_or(0.0) > 0.0  ? *h.thickness_mm
                                                      : 1.0;
  double smallest = 0.0;
  for (std::size_t n = 1; n < levels.size(); ++n)
    smallest = n == 1 ? levels[1] - levels[0] : std::min(smallest, levels[n] - levels[n - 1]);
  const auto fits = [&](double s) {
    return std::all_of(levels.begin(), levels.end(), [&](double level) {
      const double k = (level - levels.front()) / s;
      return std::abs(k - std::round(k)) * s <= std::max(0.01 * s + 0.005, std::min(roundedWithin_mm, 0.1 * s));
    });
  };
  // What the header calls spacing is a cross-check: positions decide where they can.
  if (levels.size() > 1 && (!fits(step) || smallest < 0.9 * step)) step = smallest;
  if (levels.size() > 1 && !fits(step))
    throw BadInput("has frames that are not evenly spaced: the smallest distance of two is " +
                   std::to_string(smallest) + " mm, and the others are no multiples of it");
  if (levels.size() > 1)  // the mean step, exact for rounded positions
    step = (levels.back() - levels.front()) / std::round((levels.back() - levels.front()) / step);
  image::Grid g;
  g.direction.col(0) = h.row;
  g.direction.col(1) = h.column;
  g.direction.col(2) = normal;
  g.spacing_mm = {h.columnSpacing_mm, h.rowSpacing_mm, step};
  const double slices = std::round((levels.back() - levels.front()) / step) + 1.0;
  if (slices > 100000.0) throw BadInput("spans more than 100,000 slices");
  g.size = {h.columns, h.rows, static_cast<int>(slices)};
  const auto lowest = static_cast<std::size_t>(std::min_element(at.begin(), at.end()) - at.begin());
  g.origin_lps_mm = h.frames[lowest].position_lps_mm;
  g.check();
  for (std::size_t n = 0; n < at.size(); ++n) {
    const double k = std::round((at[n] - levels.front()) / step);
    sliceOfFrame.push_back(static_cast<int>(k));
    const Eigen::Vector3d expected = g.indexToLps({0, 0, k});
    if ((expected - h.frames[n].position_lps_mm).norm() > 0.02 + 0.002 * k * step)
      throw BadInput("has frames shifted against each other in their plane (frame " + std::to_string(n + 1) + ")");
  }
  return g;
}

/// Sets the voxels of a frame that holds one segment, from the voxel first on.
void addFrame(const SegHeader& h, int number, const std::vector<std::uint8_t>& values, std::size_t first,
              SegmentationSet& set) {
  const auto segment =
      std::find_if(set.segments.begin(), set.segments.end(), [number](const Segment& s) { return s.number == number; });
  if (segment == set.segments.end())
    throw BadInput("has a frame of segment " + std::to_string(number) + ", which it does not describe");
  std::uint8_t* to = segment->mask.values.data() + first;
  for (std::size_t i = 0; i < h.pixels(); ++i)
    if (h.fractional ? 2 * values[i] >= h.maximum : values[i] != 0) to[i] = 1;
}

/// The same of a frame that holds a segment's number at every pixel; returns the numbers that it holds.
std::set<int> addLabels(const SegHeader& h, const std::vector<std::uint8_t>& bytes, std::size_t first,
                        SegmentationSet& set) {
  std::set<int> held;
  std::map<int, std::uint8_t*> masks;
  for (Segment& s : set.segments) masks[s.number] = s.mask.values.data() + first;
  for (std::size_t i = 0; i < h.pixels(); ++i) {
    const int label = h.bits == 16 ? bytes[2 * i] | bytes[2 * i + 1] << 8 : bytes[i];
    if (label == 0) continue;
    const auto mask = masks.find(label);
    if (mask == masks.end())
      throw BadInput("holds the label " + std::to_string(label) + ", which it does not describe as a segment");
    mask->second[i] = 1;
    held.insert(label);
  }
  return held;
}

/// Masks of all segments. frame(n): its pixels (SegHeader::frameBytes).
SegmentationSet assembled(SegHeader h, std::uint64_t fileBytes,
                          const std::function<std::vector<std::uint8_t>(std::size_t)>& frame) {
  SegmentationSet set = std::move(h.about);
  std::vector<int> sliceOfFrame;
  const image::Grid grid = latticeOf(h, sliceOfFrame);
  // A mask takes 8 bytes for each that a packed file holds; slices without frames and segments multiply.
  const std::uint64_t need = grid.voxelCount() * set.segments.size();
  if (need > memoryBudget(fileBytes) + 32 * fileBytes + (1ULL << 30))
    throw BadInput("holds " + std::to_string(set.segments.size()) + " segments of " +
                   std::to_string(grid.voxelCount()) + " voxels, which do not fit the memory budget");
  for (Segment& s : set.segments) s.mask = image::Mask(grid);
  for (std::size_t n = 0; n < h.frames.size(); ++n) {
    const std::size_t first = static_cast<std::size_t>(sliceOfFrame[n]) * h.pixels();
    const SegFrame& f = h.frames[n];
    std::set<int> held = {f.segment};
    if (h.labelMap)
      held = addLabels(h, frame(n), first, set);
    else
      addFrame(h, f.segment, frame(n), first, set);
    if (f.sourceSopInstanceUid.empty()) continue;
    for (const int segment : held) set.frames.push_back({segment, f.position_lps_mm, f.sourceSopInstanceUid});
  }
  if (h.fractional) set.warnings.push_back("is a fractional segmentation: voxels from one half on were taken");
  return set;
}

}  // namespace

SegmentationSet readSegmentation(const std::filesystem::path& file) {
  return detail::naming(file, [&]() -> SegmentationSet {
    ByteSource source(file);
    if (const auto layout = plainLayout(source)) {
      SegHeader h = detail::parseSegHeader(source, *layout);
      const PackedFrames packed(source, *layout, h.frames.size(), h.frameBytes(), h.bits == 1 ? 1 : 8);
      return assembled(std::move(h), source.size(), [&packed](std::size_t n) { return packed.frame(n); });
    }
    IsolatedFile isolated(file);
    SegHeader h = isolated.segmentation();
    return assembled(std::move(h), source.size(), [&isolated, bytes = h.frameBytes()](std::size_t n) {
      return isolated.frame(static_cast<int>(n), bytes);
    });
  });
}

bool isSegmentation(const std::filesystem::path& file) {
  try {
    ByteSource source(file);
    const auto layout = plainLayout(source);
    const auto known = [](const std::string& sopClass) {
      return sopClass == UID_SegmentationStorage || sopClass == detail::labelMapStorage;
    };
    if (layout && !layout->sopClassUid.empty()) return known(layout->sopClassUid);
    if (!layout) {
      IsolatedFile isolated(file);
      isolated.segmentation();
      return true;
    }
    DcmDataset data;
    parseHeader(source, *layout, data);
    return known(text(data, DCM_SOPClassUID));
  } catch (const RefusedFile&) {
    return false;
  } catch (const BadInput&) {
    return false;
  }
}

image::Mask maskOf(const SegmentationSet& set, int number) {
  if (set.segments.empty()) throw BadInput("the segmentation holds no segment");
  image::Mask all(set.segments.front().mask.grid);
  bool known = false, any = false;
  std::ostringstream there;
  for (const Segment& s : set.segments) {
    there << (there.tellp() > 0 ? ", " : "") << s.number << " '" << s.label << "'";
    if (number != 0 && s.number != number) continue;
    known = true;
    for (std::size_t n = 0; n < all.values.size(); ++n)
      if (s.mask.values[n] != 0) {
        all.values[n] = 1;
        any = true;
      }
  }
  if (!known)
    throw BadInput("the segmentation has no segment number " + std::to_string(number) + "; it holds " + there.str());
  if (!any) throw BadInput("segment " + std::to_string(number) + " of the segmentation has no voxel inside");
  return all;
}

}  // namespace glisson::dicom
