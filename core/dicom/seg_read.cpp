#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/packed_frames.h"
#include "dicom/seg.h"

namespace glisson::dicom {
namespace {

constexpr double positionTolerance_mm = 0.01;
constexpr std::size_t maxFrames = 100'000;
constexpr std::size_t maxSegments = 4096;

struct SegFrame {
  Eigen::Vector3d position_lps_mm;
  int segment = 0;
};

struct Header {
  int rows = 0, columns = 0, bits = 1;
  bool fractional = false;
  int maximum = 1;  ///< of a fractional frame
  Eigen::Vector3d row, column;
  double rowSpacing_mm = 0.0, columnSpacing_mm = 0.0;
  std::optional<double> sliceSpacing_mm, thickness_mm;
  std::vector<SegFrame> frames;
};

/// The group of a frame, from its own item or from the shared one.
DcmItem* groupOf(DcmItem* frame, DcmItem* shared, const DcmTagKey& sequence) {
  DcmItem* found = frame != nullptr ? itemOf(*frame, sequence) : nullptr;
  return found == nullptr && shared != nullptr ? itemOf(*shared, sequence) : found;
}

Eigen::Vector3d vector3(const std::vector<double>& v, std::size_t first = 0) {
  return {v[first], v[first + 1], v[first + 2]};
}

std::vector<double> exactly(DcmItem* group, const DcmTagKey& tag, std::size_t count, const std::string& where) {
  const std::vector<double> v = group != nullptr ? numbers(*group, tag) : std::vector<double>{};
  if (v.size() != count)
    throw BadInput("has no usable " + nameOf(tag) + where + " (" + std::to_string(v.size()) + " of " +
                   std::to_string(count) + " numbers)");
  return v;
}

void readGeometry(DcmItem* frame, DcmItem* shared, const std::string& where, bool first, Header& h) {
  const auto spacing = exactly(groupOf(frame, shared, DCM_PixelMeasuresSequence), DCM_PixelSpacing, 2, where);
  const auto axes =
      exactly(groupOf(frame, shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient, 6, where);
  const Eigen::Vector3d row = vector3(axes), column = vector3(axes, 3);
  if (!(spacing[0] > 0.0) || !(spacing[1] > 0.0)) throw BadInput("has a pixel spacing that is not positive" + where);
  if (std::abs(row.norm() - 1.0) > 1e-3 || std::abs(column.norm() - 1.0) > 1e-3 || std::abs(row.dot(column)) > 1e-4)
    throw BadInput("has an image orientation that is no pair of perpendicular unit vectors" + where);
  if (first) {
    h.row = row.normalized();
    h.column = (column - column.dot(h.row) * h.row).normalized();
    h.rowSpacing_mm = spacing[0];
    h.columnSpacing_mm = spacing[1];
    if (DcmItem* measures = groupOf(frame, shared, DCM_PixelMeasuresSequence)) {
      h.sliceSpacing_mm = number(*measures, DCM_SpacingBetweenSlices);
      h.thickness_mm = number(*measures, DCM_SliceThickness);
    }
  } else if ((row - h.row).norm() > 1e-3 || (column - h.column).norm() > 1e-3 ||
             std::abs(spacing[0] - h.rowSpacing_mm) > 1e-4 * h.rowSpacing_mm ||
             std::abs(spacing[1] - h.columnSpacing_mm) > 1e-4 * h.columnSpacing_mm) {
    throw BadInput("has frames of different orientation or pixel spacing" + where);
  }
}

int wholeNumber(DcmItem& item, const DcmTagKey& tag, double low, double high) {
  const auto value = number(item, tag);
  if (!value || *value < low || *value > high || *value != std::floor(*value))
    throw BadInput("has " + nameOf(tag) + " missing or out of range");
  return static_cast<int>(*value);
}

void readFrames(DcmDataset& data, std::size_t count, Header& h, SegmentationSet& set) {
  DcmItem* shared = itemOf(data, DCM_SharedFunctionalGroupsSequence);
  DcmSequenceOfItems* perFrame = nullptr;
  if (data.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame).bad() || perFrame == nullptr ||
      perFrame->card() != count)
    throw BadInput("has no functional group for each of its " + std::to_string(count) + " frames");
  std::set<std::string> images;
  std::size_t n = 0;
  for (DcmObject* o = perFrame->nextInContainer(nullptr); o != nullptr; o = perFrame->nextInContainer(o), ++n) {
    auto* frame = static_cast<DcmItem*>(o);
    const std::string where = " (frame " + std::to_string(n + 1) + ")";
    readGeometry(frame, shared, where, n == 0, h);
    SegFrame f;
    f.position_lps_mm =
        vector3(exactly(groupOf(frame, shared, DCM_PlanePositionSequence), DCM_ImagePositionPatient, 3, where));
    if (f.position_lps_mm.cwiseAbs().maxCoeff() > 1e5) throw BadInput("lies more than 100 m from the scanner" + where);
    DcmItem* identification = groupOf(frame, shared, DCM_SegmentIdentificationSequence);
    if (identification == nullptr) throw BadInput("does not say which segment a frame belongs to" + where);
    f.segment = wholeNumber(*identification, DCM_ReferencedSegmentNumber, 1, 65535);
    h.frames.push_back(f);
    if (DcmItem* derivation = groupOf(frame, shared, DCM_DerivationImageSequence))
      if (DcmItem* source = itemOf(*derivation, DCM_SourceImageSequence))
        if (const std::string uid = shownText(*source, DCM_ReferencedSOPInstanceUID);
            !uid.empty() && images.insert(uid).second)
          set.referencedSopInstanceUids.push_back(uid);
  }
}

/// One lattice for all frames: ordered along the normal, a whole number of steps apart.
image::Grid latticeOf(const Header& h, std::vector<int>& sliceOfFrame) {
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
      return std::abs(k - std::round(k)) * s <= 0.01 * s + 0.005;
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

void readSegments(DcmDataset& data, SegmentationSet& set) {
  DcmSequenceOfItems* items = nullptr;
  if (data.findAndGetSequence(DCM_SegmentSequence, items).bad() || items == nullptr)
    throw BadInput("describes no segments");
  for (DcmObject* o = items->nextInContainer(nullptr); o != nullptr; o = items->nextInContainer(o)) {
    auto& item = *static_cast<DcmItem*>(o);
    Segment s;
    s.number = wholeNumber(item, DCM_SegmentNumber, 1, 65535);
    s.label = shownText(item, DCM_SegmentLabel);
    if (DcmItem* type = itemOf(item, DCM_SegmentedPropertyTypeCodeSequence))
      s.propertyCode = shownText(*type, DCM_CodingSchemeDesignator) + ":" + shownText(*type, DCM_CodeValue);
    for (const Segment& other : set.segments)
      if (other.number == s.number)
        throw BadInput("uses " + nameOf(DCM_SegmentNumber) + " " + std::to_string(s.number) + " twice");
    set.segments.push_back(std::move(s));
    if (set.segments.size() > maxSegments) throw BadInput("describes more than 4096 segments");
  }
  std::sort(set.segments.begin(), set.segments.end(),
            [](const Segment& a, const Segment& b) { return a.number < b.number; });
}

SegmentationSet read(const std::filesystem::path& file) {
  ByteSource source(file);
  const std::uint64_t fileBytes = source.size();
  const FileLayout layout = readLayout(source);
  DcmDataset data;
  parseHeader(source, layout, data);
  SegmentationSet set;
  if (text(data, DCM_SOPClassUID) != UID_SegmentationStorage)
    throw BadInput("is no Segmentation (modality '" + shownText(data, DCM_Modality) + "')");
  set.warnings = layout.warnings;
  set.frameOfReferenceUid = shownText(data, DCM_FrameOfReferenceUID);
  if (DcmItem* series = itemOf(data, DCM_ReferencedSeriesSequence))
    set.referencedSeriesUid = shownText(*series, DCM_SeriesInstanceUID);
  readSegments(data, set);

  Header h;
  h.rows = wholeNumber(data, DCM_Rows, 1, 65535);
  h.columns = wholeNumber(data, DCM_Columns, 1, 65535);
  h.bits = wholeNumber(data, DCM_BitsAllocated, 1, 64);
  const std::string type = shownText(data, DCM_SegmentationType);
  h.fractional = type == "FRACTIONAL";
  if ((type != "BINARY" && !h.fractional) || h.bits != (h.fractional ? 8 : 1))
    throw BadInput("is of type '" + type + "' with " + std::to_string(h.bits) +
                   " bits a pixel; BINARY with 1 and FRACTIONAL with 8 are read");
  if (h.fractional) h.maximum = wholeNumber(data, DCM_MaximumFractionalValue, 1, 255);
  const auto frames = static_cast<std::size_t>(wholeNumber(data, DCM_NumberOfFrames, 1, maxFrames));
  const auto pixels = static_cast<std::size_t>(h.rows) * static_cast<std::size_t>(h.columns);
  const PackedFrames packed(source, layout, frames, pixels, h.bits);
  readFrames(data, frames, h, set);
  std::vector<int> sliceOfFrame;
  const image::Grid grid = latticeOf(h, sliceOfFrame);
  // A mask takes 8 bytes for each that a packed file holds; slices without frames and segments multiply.
  const std::uint64_t need = grid.voxelCount() * set.segments.size();
  if (need > memoryBudget(fileBytes) + 32 * fileBytes + (1ULL << 30))
    throw BadInput("holds " + std::to_string(set.segments.size()) + " segments of " +
                   std::to_string(grid.voxelCount()) + " voxels, which do not fit the memory budget");
  for (Segment& s : set.segments) s.mask = image::Mask(grid);
  for (std::size_t n = 0; n < frames; ++n) {
    const auto segment = std::find_if(set.segments.begin(), set.segments.end(),
                                      [&](const Segment& s) { return s.number == h.frames[n].segment; });
    if (segment == set.segments.end())
      throw BadInput("has a frame of segment " + std::to_string(h.frames[n].segment) + ", which it does not describe");
    const std::vector<std::uint8_t> values = packed.frame(n);
    std::uint8_t* to = segment->mask.values.data() + static_cast<std::size_t>(sliceOfFrame[n]) * pixels;
    for (std::size_t i = 0; i < pixels; ++i)
      if (h.fractional ? 2 * values[i] >= h.maximum : values[i] != 0) to[i] = 1;
  }
  if (h.fractional) set.warnings.push_back("is a fractional segmentation: voxels from one half on were taken");
  return set;
}

}  // namespace

SegmentationSet readSegmentation(const std::filesystem::path& file) {
  const std::string which = "'" + file.filename().string() + "' ";
  try {
    return read(file);
  } catch (const BadInput& e) {
    throw BadInput(which + e.what());
  } catch (const std::bad_alloc&) {
    throw BadInput(which + "does not fit into memory");
  }
}

bool isSegmentation(const std::filesystem::path& file) {
  try {
    ByteSource source(file);
    const FileLayout layout = readLayout(source);
    if (layout.sopClassUid == UID_SegmentationStorage) return true;
    if (!layout.sopClassUid.empty()) return false;
    DcmDataset data;
    parseHeader(source, layout, data);
    return text(data, DCM_SOPClassUID) == UID_SegmentationStorage;
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
