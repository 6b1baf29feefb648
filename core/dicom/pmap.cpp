// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/pmap.h"

#include <algorithm>
#include <cmath>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

constexpr Code quantityConcept{"246205007", "SCT", "Quantity"};
constexpr Code derivedByCalculation{"113072", "DCM", "Multiplication"};
constexpr Code sourceForProcessing{"121322", "DCM", "Source image for image processing operation"};

void writeScale(Writer& shared, const image::ScalarVolume& v, StiffnessQuantity quantity) {
  const bool shear = quantity == StiffnessQuantity::Shear;
  shared.group(DCM_RealWorldValueMappingSequence, [&](Writer& w) {
    w.text(DCM_LUTExplanation, shear ? "Shear modulus in kPa" : "Young's modulus in kPa");
    w.text(DCM_LUTLabel, shear ? "MU_KPA" : "E_KPA");
    w.code(DCM_MeasurementUnitsCodeSequence, codes::kilopascal);
    const auto [low, high] = std::minmax_element(v.values.begin(), v.values.end());
    w.real(DCM_DoubleFloatRealWorldValueFirstValueMapped, static_cast<double>(*low));
    w.real(DCM_DoubleFloatRealWorldValueLastValueMapped, static_cast<double>(*high));
    w.real(DCM_RealWorldValueIntercept, 0.0);
    w.real(DCM_RealWorldValueSlope, 1.0);
    w.group(DCM_QuantityDefinitionSequence, [&](Writer& q) {
      q.text(DCM_ValueType, "CODE");
      q.code(DCM_ConceptNameCodeSequence, quantityConcept);
      q.code(DCM_ConceptCodeSequence, shear ? codes::shearModulus : codes::youngsModulus);
    });
  });
}

void check(const image::ScalarVolume& v, const Series& source) {
  checkReferable(source, "a Parametric Map");
  if (!v.grid.sameGeometry(source.grid))
    throw BadArgument("a Parametric Map must lie on the grid of its source series");
  if (!std::all_of(v.values.begin(), v.values.end(), [](float x) { return std::isfinite(x); }))
    throw BadInput("a Parametric Map cannot hold values that are not finite; mark missing values with 0");
}

constexpr const char* frameType = "DERIVED\\PRIMARY\\STIFFNESS\\NONE";

void writeContent(Writer& root, DcmDataset& data, const image::Grid& g) {
  root.text(DCM_ImageType, frameType);
  root.text(DCM_ContentLabel, "RESEARCH");
  root.text(DCM_ContentDescription, "Research use only");
  root.text(DCM_ContentCreatorName, "");
  root.text(DCM_ContentQualification, "RESEARCH");
  root.text(DCM_BurnedInAnnotation, "NO");
  root.text(DCM_RecognizableVisualFeatures, "NO");
  root.text(DCM_LossyImageCompression, "00");
  root.text(DCM_PresentationLUTShape, "IDENTITY");
  root.word(DCM_SamplesPerPixel, 1);
  root.text(DCM_PhotometricInterpretation, "MONOCHROME2");
  root.number(DCM_NumberOfFrames, g.size.z());
  root.word(DCM_Rows, g.size.y());
  root.word(DCM_Columns, g.size.x());
  root.word(DCM_BitsAllocated, 32);
  Writer::check(data.insertEmptyElement(DCM_AcquisitionContextSequence), DCM_AcquisitionContextSequence);
}

/// What holds for every frame.
void describeShared(Writer& shared, const image::Grid& grid, const image::ScalarVolume& v, StiffnessQuantity quantity) {
  writeSharedGeometry(shared, grid);
  shared.group(DCM_ParametricMapFrameTypeSequence, [](Writer& w) { w.text(DCM_FrameType, frameType); });
  shared.group(DCM_FrameAnatomySequence, [](Writer& w) {
    w.text(DCM_FrameLaterality, "U");
    w.code(DCM_AnatomicRegionSequence, codes::liver);
  });
  shared.group(DCM_PixelValueTransformationSequence, [](Writer& w) {
    w.decimals(DCM_RescaleIntercept, {0.0});
    w.decimals(DCM_RescaleSlope, {1.0});
    w.text(DCM_RescaleType, "US");
  });
  shared.group(DCM_FrameVOILUTSequence, [](Writer& w) {
    w.decimals(DCM_WindowCenter, {4.0});
    w.decimals(DCM_WindowWidth, {8.0});
  });
  writeScale(shared, v, quantity);
}

void describeFrame(Writer& root, const Series& source, int k) {
  root.group(DCM_PerFrameFunctionalGroupsSequence, [&](Writer& frame) {
    writeDerivation(frame, source, static_cast<std::size_t>(k), derivedByCalculation, sourceForProcessing);
    frame.group(DCM_FrameContentSequence,
                [&](Writer& w) { w.longWords(DCM_DimensionIndexValues, {static_cast<std::uint32_t>(k + 1)}); });
    writePlanePosition(frame, source.grid, k);
  });
}

}  // namespace

void writeParametricMap(const std::filesystem::path& file, const image::ScalarVolume& v, StiffnessQuantity quantity,
                        const Series& source, std::uint64_t seed) {
  check(v, source);
  const bool shear = quantity == StiffnessQuantity::Shear;
  const std::string identity = "pmap/" + source.uid + "/" + std::to_string(seed) + "/" + (shear ? "mu" : "E") +
                               sha256(v.values.data(), v.values.size() * sizeof(float));
  DcmDataset image;
  readSourceHeader(source, image);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  writeDerivedHeader(
      data, image, source,
      {UID_ParametricMapStorage, "MR",
       shear ? "RESEARCH stiffness map, shear modulus (kPa)" : "RESEARCH stiffness map, Young's modulus (kPa)",
       9200 + source.number % 1000, identity});
  Writer root(data);
  writeContent(root, data, source.grid);
  referToSeries(data, source);
  writeCodingSchemes(data);
  writeDimensions(root, uidFrom(identity + "/dimensions"), {{DCM_ImagePositionPatient, DCM_PlanePositionSequence}});
  root.group(DCM_SharedFunctionalGroupsSequence,
             [&](Writer& shared) { describeShared(shared, source.grid, v, quantity); });
  for (int k = 0; k < source.grid.size.z(); ++k) describeFrame(root, source, k);
  Writer::check(
      data.putAndInsertFloat32Array(DCM_FloatPixelData, v.values.data(), static_cast<unsigned long>(v.values.size())),
      DCM_FloatPixelData);
  saveDicom(format, file, EXS_LittleEndianExplicit);
}

}  // namespace glisson::dicom
