// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/writer.h"
#include "dicom/seg.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

constexpr Code segmentation{"113076", "DCM", "Segmentation"};
constexpr Code sourceForProcessing{"121322", "DCM", "Source image for image processing operation"};

std::size_t sliceVoxels(const image::Grid& g) {
  return static_cast<std::size_t>(g.size.x()) * static_cast<std::size_t>(g.size.y());
}

/// The values of one slice.
const std::uint8_t* sliceOf(const image::Mask& mask, int k) {
  return mask.values.data() + static_cast<std::size_t>(k) * sliceVoxels(mask.grid);
}

void check(const std::vector<Segment>& segments, const Series& source) {
  checkReferable(source, "a Segmentation");
  bool any = false;
  for (const Segment& s : segments) {
    if (!s.mask.grid.sameGeometry(source.grid))
      throw BadArgument("segment " + std::to_string(s.number) + " does not lie on the grid of its source series");
    if (s.label.empty() || s.label.size() > 64)
      throw BadInput("the label of segment " + std::to_string(s.number) + " must have 1 to 64 characters");
    any = any || std::any_of(s.mask.values.begin(), s.mask.values.end(), [](std::uint8_t v) { return v != 0; });
  }
  if (!any) throw BadInput("nothing is segmented: every mask is empty");
}

void describe(Writer& root, const Segment& s) {
  root.group(DCM_SegmentSequence, [&](Writer& w) {
    w.word(DCM_SegmentNumber, s.number);
    w.text(DCM_SegmentLabel, s.label);
    w.text(DCM_SegmentAlgorithmType, "MANUAL");
    w.code(DCM_SegmentedPropertyCategoryCodeSequence, codes::organ);
    w.code(DCM_SegmentedPropertyTypeCodeSequence, codes::liver);
    const std::array<Uint16, 3> softRed = {37000, 47000, 40000};  // CIELab
    Writer::check(w.item().putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, softRed.data(), 3),
                  DCM_RecommendedDisplayCIELabValue);
    w.text(DCM_TrackingID, s.label);
    w.text(DCM_TrackingUID, uidFrom("tracking/" + s.label + "/" + sha256(s.mask.values.data(), s.mask.values.size())));
  });
}

void writeContent(Writer& root, const image::Grid& g) {
  root.text(DCM_ImageType, "DERIVED\\PRIMARY");
  root.text(DCM_ContentLabel, "RESEARCH");
  root.text(DCM_ContentDescription, "Research use only");
  root.text(DCM_ContentCreatorName, "");
  root.text(DCM_SegmentationType, "BINARY");
  root.text(DCM_LossyImageCompression, "00");
  root.word(DCM_SamplesPerPixel, 1);
  root.text(DCM_PhotometricInterpretation, "MONOCHROME2");
  root.word(DCM_Rows, g.size.y());
  root.word(DCM_Columns, g.size.x());
  root.word(DCM_BitsAllocated, 1);
  root.word(DCM_BitsStored, 1);
  root.word(DCM_HighBit, 0);
  root.word(DCM_PixelRepresentation, 0);
}

/// Bits of all frames follow each other without padding, the first pixel in the lowest bit.
class PackedBits {
 public:
  void add(const std::uint8_t* values, std::size_t count) {
    bytes_.resize((bit_ + count + 7) / 8, 0);
    for (std::size_t n = 0; n < count; ++n, ++bit_)
      if (values[n] != 0) bytes_[bit_ / 8] = static_cast<std::uint8_t>(bytes_[bit_ / 8] | (1U << (bit_ % 8)));
  }
  /// Values have even length.
  std::vector<std::uint8_t> evenBytes() const {
    std::vector<std::uint8_t> even = bytes_;
    if (even.size() % 2) even.push_back(0);
    return even;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t bit_ = 0;
};

void describeFrame(Writer& root, const Segment& s, const Series& source, int k) {
  root.group(DCM_PerFrameFunctionalGroupsSequence, [&](Writer& frame) {
    writeDerivation(frame, source, static_cast<std::size_t>(k), segmentation, sourceForProcessing);
    frame.group(DCM_FrameContentSequence, [&](Writer& w) {
      w.longWords(DCM_DimensionIndexValues, {static_cast<std::uint32_t>(s.number), static_cast<std::uint32_t>(k + 1)});
    });
    writePlanePosition(frame, source.grid, k);
    frame.group(DCM_SegmentIdentificationSequence, [&](Writer& w) { w.word(DCM_ReferencedSegmentNumber, s.number); });
  });
}

/// One frame for each slice of a segment that holds a voxel; notes which slice became which frame.
void writeFrames(Writer& root, DcmDataset& data, const std::vector<Segment>& segments, const Series& source,
                 WrittenSegmentation& written) {
  const std::size_t voxels = sliceVoxels(source.grid);
  PackedBits bits;
  int frames = 0;
  for (const Segment& s : segments) {
    auto& frameOfSlice = written.frameOfSlice.emplace_back(static_cast<std::size_t>(source.grid.size.z()), 0);
    for (int k = 0; k < source.grid.size.z(); ++k) {
      const std::uint8_t* values = sliceOf(s.mask, k);
      if (std::all_of(values, values + voxels, [](std::uint8_t v) { return v == 0; })) continue;
      frameOfSlice[static_cast<std::size_t>(k)] = ++frames;
      bits.add(values, voxels);
      describeFrame(root, s, source, k);
    }
  }
  root.number(DCM_NumberOfFrames, frames);
  const std::vector<std::uint8_t> pixels = bits.evenBytes();
  Writer::check(data.putAndInsertUint8Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size())),
                DCM_PixelData);
}

}  // namespace

WrittenSegmentation writeSegmentation(const std::filesystem::path& file, const std::vector<Segment>& segments,
                                      const Series& source, std::uint64_t seed) {
  check(segments, source);
  std::string identity = "seg/" + source.uid + "/" + std::to_string(seed);
  for (const Segment& s : segments)
    identity += "/" + std::to_string(s.number) + s.label + sha256(s.mask.values.data(), s.mask.values.size());
  DcmDataset image;
  readSourceHeader(source, image);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  writeDerivedHeader(data, image, source,
                     {UID_SegmentationStorage, "SEG", "RESEARCH segmentation", 9100 + source.number % 1000, identity});
  WrittenSegmentation written;
  written.sopInstanceUid = uidFrom(identity + "/instance");
  written.seriesInstanceUid = uidFrom(identity + "/series");
  Writer root(data);
  writeContent(root, source.grid);
  referToSeries(data, source);
  const std::string dimensions = uidFrom(identity + "/dimensions");
  writeDimensions(root, dimensions,
                  {{DCM_ReferencedSegmentNumber, DCM_SegmentIdentificationSequence},
                   {DCM_ImagePositionPatient, DCM_PlanePositionSequence}});
  for (const Segment& s : segments) describe(root, s);
  root.group(DCM_SharedFunctionalGroupsSequence, [&](Writer& shared) { writeSharedGeometry(shared, source.grid); });
  writeFrames(root, data, segments, source, written);
  saveDicom(format, file, EXS_LittleEndianExplicit);
  return written;
}

}  // namespace glisson::dicom
