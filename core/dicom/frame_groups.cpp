// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/frame_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>

#include "base/error.h"
#include "dicom/detail/attributes.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include "dicom/detail/frame_values.h"

namespace glisson::dicom {
namespace {

/// Where an attribute of a frame may stand: the frame's own functional groups, the shared ones, or the data set itself.
class FrameView {
 public:
  FrameView(DcmItem& data, DcmItem* shared, DcmItem* own) : data_(data), shared_(shared), own_(own) {}

  /// The item that holds the attributes of one functional group; the data set where the file has no such group.
  DcmItem& group(const DcmTagKey& sequence) const {
    if (DcmItem* item = own_ != nullptr ? itemOf(*own_, sequence) : nullptr) return *item;
    if (DcmItem* item = shared_ != nullptr ? itemOf(*shared_, sequence) : nullptr) return *item;
    return data_;
  }

  /// What holds the real-world value maps; null where there is none.
  DcmItem* mapping() const {
    for (DcmItem* holder : {own_, shared_, &data_})
      if (holder != nullptr && itemOf(*holder, DCM_RealWorldValueMappingSequence) != nullptr) return holder;
    return nullptr;
  }

 private:
  DcmItem& data_;
  DcmItem* shared_;
  DcmItem* own_;
};

[[noreturn]] void refuse(const DcmTagKey& tag, const std::vector<double>& seen, const std::string& expected) {
  std::ostringstream why;
  why << nameOf(tag);
  if (seen.empty()) {
    why << " is missing or empty; " << expected;
  } else {
    why << " is";
    for (std::size_t n = 0; n < std::min<std::size_t>(seen.size(), 6); ++n) why << (n > 0 ? "\\" : " ") << seen[n];
    why << "; " << expected;
  }
  throw BadInput(why.str());
}

void readGeometry(const FrameView& view, Frame& frame) {
  const std::vector<double> position = numbers(view.group(DCM_PlanePositionSequence), DCM_ImagePositionPatient);
  if (position.size() != 3) refuse(DCM_ImagePositionPatient, position, "three numbers (x, y, z in mm) were expected");
  frame.position_lps_mm = Eigen::Vector3d(position[0], position[1], position[2]);
  if (frame.position_lps_mm.cwiseAbs().maxCoeff() > 1e5)
    refuse(DCM_ImagePositionPatient, position, "no place in a scanner is 100 m away");

  const std::vector<double> o = numbers(view.group(DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient);
  if (o.size() != 6) refuse(DCM_ImageOrientationPatient, o, "six direction cosines were expected");
  const Eigen::Vector3d row(o[0], o[1], o[2]);
  const Eigen::Vector3d column(o[3], o[4], o[5]);
  if (std::abs(row.norm() - 1.0) > 1e-3 || std::abs(column.norm() - 1.0) > 1e-3)
    refuse(DCM_ImageOrientationPatient, o, "two unit vectors were expected");
  if (std::abs(row.normalized().dot(column.normalized())) > 1e-4)
    refuse(DCM_ImageOrientationPatient, o, "its two vectors must be at a right angle (to 1e-4 rad)");
  frame.row = row.normalized();
  frame.column = (column - column.dot(frame.row) * frame.row).normalized();

  DcmItem& measures = view.group(DCM_PixelMeasuresSequence);
  const std::vector<double> spacing = numbers(measures, DCM_PixelSpacing);
  if (spacing.size() != 2 || spacing[0] <= 0.0 || spacing[1] <= 0.0 || spacing[0] > 1000.0 || spacing[1] > 1000.0)
    refuse(DCM_PixelSpacing, spacing, "two positive numbers (row\\column spacing in mm) were expected");
  frame.rowSpacing_mm = spacing[0];
  frame.columnSpacing_mm = spacing[1];
  // Only cross-checked, so that a senseless value is as good as none.
  const auto lenient = [&measures](const DcmTagKey& tag) -> std::optional<double> {
    try {
      const auto value = number(measures, tag);
      return value && std::abs(*value) > 0.0 && std::abs(*value) < 1000.0 ? std::optional(std::abs(*value))
                                                                          : std::nullopt;
    } catch (const BadInput&) {
      return std::nullopt;
    }
  };
  frame.thickness_mm = lenient(DCM_SliceThickness);
  frame.statedSpacing_mm = lenient(DCM_SpacingBetweenSlices);
}

/// The frame's places along the dimensions that its file declares, but for those that count slices.
void addDimensions(DcmItem& data, DcmItem& content, Frame& frame) {
  const DcmTagKey slices[] = {DCM_InStackPositionNumber, DCM_StackID, DCM_ImagePositionPatient,
                              DCM_ImageOrientationPatient};
  const DcmTagKey times[] = {
      DCM_NominalCardiacTriggerDelayTime,  DCM_TemporalPositionIndex,  DCM_TriggerTime,
      DCM_NominalPercentageOfCardiacPhase, DCM_FrameReferenceDateTime, DCM_FrameAcquisitionDateTime};
  std::vector<double> values;
  try {
    values = numbers(content, DCM_DimensionIndexValues);
  } catch (const BadInput&) {  // no numbers: as good as none
  }
  static constexpr std::array indices = {FrameKind::DimensionIndex1, FrameKind::DimensionIndex2,
                                         FrameKind::DimensionIndex3, FrameKind::DimensionIndex4,
                                         FrameKind::DimensionIndex5};
  std::size_t other = 0;
  for (unsigned long d = 0; d < values.size() && d < 8; ++d) {
    DcmItem* dimension = itemOf(data, DCM_DimensionIndexSequence, d);
    DcmElement* element = nullptr;
    DcmTagKey pointer;
    if (dimension == nullptr || dimension->findAndGetElement(DCM_DimensionIndexPointer, element).bad()) continue;
    auto* attribute = dynamic_cast<DcmAttributeTag*>(element);
    if (attribute == nullptr || attribute->getTagVal(pointer).bad()) continue;
    const auto in = [&pointer](const auto& list) {
      return std::find(std::begin(list), std::end(list), pointer) != std::end(list);
    };
    if (in(slices)) continue;
    const std::string value = std::to_string(std::lround(values[d]));
    if (in(times))
      frame.kinds.emplace_back(FrameKind::TimeIndex, value);
    else if (other < indices.size())
      frame.kinds.emplace_back(indices[other++], value);
  }
}

/// Words about the values beside the description: how they were derived, and the label of their map.
std::string wordsAboutValues(const FrameView& view, DcmItem& data) {
  constexpr std::size_t most = 300;
  std::string words = shownText(data, DCM_DerivationDescription).substr(0, most);
  if (DcmItem* holder = view.mapping()) {
    DcmItem& map = *itemOf(*holder, DCM_RealWorldValueMappingSequence);
    words += ' ' + shownText(map, DCM_LUTExplanation).substr(0, most) + ' ' + shownText(map, DCM_LUTLabel);
  }
  return words;
}

void readKinds(const FrameView& view, DcmItem& data, const std::string& privateType, Frame& frame) {
  const auto add = [&frame](FrameKind what, const std::string& value) {
    if (!value.empty()) frame.kinds.emplace_back(what, value);
  };
  DcmItem& type = view.group(DCM_MRImageFrameTypeSequence);
  add(FrameKind::ImageType, text(type, &type == &data ? DCM_ImageType : DCM_FrameType));
  add(FrameKind::ComplexComponent, text(type, DCM_ComplexImageComponent));
  add(FrameKind::PrivateImageType, privateType);
  if (frame.quantity) add(FrameKind::Quantity, inWords(*frame.quantity));
  add(FrameKind::EchoNumber, text(data, DCM_EchoNumbers));
  DcmItem& echo = view.group(DCM_MREchoSequence);
  add(FrameKind::EchoTime, text(echo, &echo == &data ? DCM_EchoTime : DCM_EffectiveEchoTime));
  add(FrameKind::InversionTime, text(data, DCM_InversionTime));
  DcmItem& diffusion = view.group(DCM_MRDiffusionSequence);
  add(FrameKind::DiffusionBValue, text(diffusion, DCM_DiffusionBValue));
  DcmItem& content = view.group(DCM_FrameContentSequence);
  add(FrameKind::TemporalPosition,
      text(content, &content == &data ? DCM_TemporalPositionIdentifier : DCM_TemporalPositionIndex));
  add(FrameKind::TriggerTime, text(data, DCM_TriggerTime));
  add(FrameKind::AcquisitionNumber, text(data, DCM_AcquisitionNumber));
  add(FrameKind::WordsAboutValues, wordsAboutValues(view, data));
  if (&content == &data) return;
  add(FrameKind::TriggerDelay,
      text(view.group(DCM_CardiacSynchronizationSequence), DCM_NominalCardiacTriggerDelayTime));
  add(FrameKind::FrameAcquisitionNumber, text(content, DCM_FrameAcquisitionNumber));
  addDimensions(data, content, frame);
}

}  // namespace

void readFrames(DcmDataset& data, std::uint64_t frames, ImageHeader& header) {
  const unsigned long groups = itemCount(data, DCM_PerFrameFunctionalGroupsSequence);
  DcmItem* shared = itemOf(data, DCM_SharedFunctionalGroupsSequence);
  if (groups == 0 && frames > 1)
    throw BadInput("has " + std::to_string(frames) +
                   " frames and no functional groups, so that the place of a frame is unknown");
  if (groups > 0 && groups != frames)
    throw BadInput("has " + std::to_string(frames) + " frames, but functional groups for " + std::to_string(groups));
  const std::string privateType = privateText(data, 0x0043, 0x2F, "GEMS_PARM_01");
  header.frames.reserve(static_cast<std::size_t>(frames));
  DcmSequenceOfItems* perFrame = nullptr;
  data.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame);
  DcmObject* own = nullptr;
  for (std::uint64_t n = 0; n < frames; ++n) {
    if (groups > 0) own = perFrame->nextInContainer(own);
    Frame frame;
    frame.number = static_cast<int>(n);
    const FrameView view(data, shared, static_cast<DcmItem*>(own));
    try {
      readGeometry(view, frame);
      readValues(view.group(DCM_PixelValueTransformationSequence), view.mapping(), frame, header);
    } catch (const BadInput& e) {
      if (frames == 1) throw;
      throw BadInput("frame " + std::to_string(n + 1) + ": " + e.what());
    }
    readKinds(view, data, privateType, frame);
    header.frames.push_back(std::move(frame));
  }
}

}  // namespace glisson::dicom
