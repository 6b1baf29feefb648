// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/measurement_report.h"

#include <cmath>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/sha256.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

constexpr Code mean{"373098007", "SCT", "Mean"};
constexpr Code median{"373099004", "SCT", "Median"};
constexpr Code deviation{"386136009", "SCT", "Standard Deviation"};
constexpr Code minimum{"255605001", "SCT", "Minimum"};
constexpr Code maximum{"56851009", "SCT", "Maximum"};
constexpr Code area{"42798000", "SCT", "Area"};
constexpr Code voxels{"number-of-voxels", "99GLISSON", "Number of voxels measured"};
constexpr Code squareMillimetre{"mm2", "UCUM", "square millimeter"};
constexpr Code noUnits{"1", "UCUM", "no units"};

/// A content item and its children.
class Item {
 public:
  explicit Item(DcmItem& item) : item_(item) {}

  Item container(const char* relationship, const Code& name) {
    Item made = add(relationship, "CONTAINER", name);
    Writer(made.item_).text(DCM_ContinuityOfContent, "SEPARATE");
    return made;
  }
  Item code(const char* relationship, const Code& name, const Code& value) {
    Item made = add(relationship, "CODE", name);
    Writer(made.item_).code(DCM_ConceptCodeSequence, value);
    return made;
  }
  void text(const char* relationship, const Code& name, const std::string& value) {
    Writer(add(relationship, "TEXT", name).item_).text(DCM_TextValue, value);
  }
  void uid(const char* relationship, const Code& name, const std::string& value) {
    Writer(add(relationship, "UIDREF", name).item_).text(DCM_UID, value);
  }
  Item number(const Code& name, double value, const Code& unit) {
    Item made = add("CONTAINS", "NUM", name);
    Writer(made.item_).group(DCM_MeasuredValueSequence, [&](Writer& w) {
      w.code(DCM_MeasurementUnitsCodeSequence, unit);
      w.decimals(DCM_NumericValue, {value});
    });
    return made;
  }
  /// An image, by name or as a bare entry of the image library.
  DcmItem& image(const char* relationship, const Code* name) {
    DcmItem& made = Writer(item_).newItem(DCM_ContentSequence);
    Writer w(made);
    w.text(DCM_RelationshipType, relationship);
    w.text(DCM_ValueType, "IMAGE");
    if (name != nullptr) w.code(DCM_ConceptNameCodeSequence, *name);
    return w.newItem(DCM_ReferencedSOPSequence);
  }
  void followsTemplate(const char* identifier) {
    Writer(item_).group(DCM_ContentTemplateSequence, [&](Writer& w) {
      w.text(DCM_MappingResource, "DCMR");
      w.text(DCM_TemplateIdentifier, identifier);
    });
  }

 private:
  Item add(const char* relationship, const char* type, const Code& name) {
    DcmItem& made = Writer(item_).newItem(DCM_ContentSequence);
    Writer w(made);
    w.text(DCM_RelationshipType, relationship);
    w.text(DCM_ValueType, type);
    w.code(DCM_ConceptNameCodeSequence, name);
    return Item(made);
  }
  DcmItem& item_;
};

void writeContext(Item& root) {
  root.code("HAS CONCEPT MOD", {"121049", "DCM", "Language of Content Item and Descendants"},
            {"en", "RFC5646", "English"});
  root.code("HAS OBS CONTEXT", {"121005", "DCM", "Observer Type"}, {"121007", "DCM", "Device"});
  root.uid("HAS OBS CONTEXT", {"121012", "DCM", "Device Observer UID"}, uidFrom("glisson/device observer"));
  root.text("HAS OBS CONTEXT", {"121013", "DCM", "Device Observer Name"}, "Glisson");
  root.code("HAS CONCEPT MOD", {"121058", "DCM", "Procedure reported"},
            {"113091000", "SCT", "Magnetic resonance imaging"});
}

void writeLibrary(Item& root, const Series& source) {
  Item library = root.container("CONTAINS", {"111028", "DCM", "Image Library"});
  Item group = library.container("CONTAINS", {"126200", "DCM", "Image Library Group"});
  for (std::size_t n = 0; n < source.sopInstanceUids.size(); ++n) {
    Writer w(group.image("CONTAINS", nullptr));
    w.text(DCM_ReferencedSOPClassUID, source.sopClassUid);
    w.text(DCM_ReferencedSOPInstanceUID, source.sopInstanceUids[n]);
  }
}

void writeRegion(Item& measurements, const ReportedStiffness& r, const Code& modulus, const WrittenSegmentation& seg,
                 const Series& source, const std::string& identity) {
  Item group = measurements.container("CONTAINS", {"125007", "DCM", "Measurement Group"});
  group.followsTemplate(r.slice ? "1410" : "1411");
  group.text("HAS OBS CONTEXT", {"112039", "DCM", "Tracking Identifier"}, r.name);
  group.uid("HAS OBS CONTEXT", {"112040", "DCM", "Tracking Unique Identifier"},
            uidFrom(identity + "/tracking/" + r.name));
  group.code("CONTAINS", {"121071", "DCM", "Finding"}, codes::organ);
  const Code segmentName =
      r.slice ? Code{"121214", "DCM", "Referenced Segmentation Frame"} : Code{"121191", "DCM", "Referenced Segment"};
  Writer segment(group.image("CONTAINS", &segmentName));
  segment.text(DCM_ReferencedSOPClassUID, UID_SegmentationStorage);
  segment.text(DCM_ReferencedSOPInstanceUID, seg.sopInstanceUid);
  if (r.slice)
    segment.number(DCM_ReferencedFrameNumber, seg.frameOfSlice.at(0).at(static_cast<std::size_t>(*r.slice)));
  else
    segment.word(DCM_ReferencedSegmentNumber, 1);  // one or the other: a frame belongs to one segment
  if (r.slice) {
    const Code sourceImage{"121233", "DCM", "Source image for segmentation"};
    referToSlice(group.image("CONTAINS", &sourceImage), source, static_cast<std::size_t>(*r.slice));
  } else {
    group.uid("CONTAINS", {"121232", "DCM", "Source series for segmentation"}, seriesInstanceUid(source));
  }
  group.code("HAS CONCEPT MOD", {"363698007", "SCT", "Finding Site"}, codes::liver);
  group.number(voxels, static_cast<double>(r.n), noUnits);
  group.number(area, r.area_mm2, squareMillimetre);
  const std::pair<const Code*, double> statistics[] = {{&mean, r.mean_kPa},
                                                       {&median, r.median_kPa},
                                                       {&deviation, r.sd_kPa},
                                                       {&minimum, r.min_kPa},
                                                       {&maximum, r.max_kPa}};
  for (const auto& [derivation, value] : statistics) {
    if (!std::isfinite(value)) continue;
    Item number = group.number(codes::elasticity, value, codes::kilopascal);
    number.code("HAS CONCEPT MOD", {"121050", "DCM", "Equivalent Meaning of Concept Name"}, modulus);
    number.code("HAS CONCEPT MOD", {"121401", "DCM", "Derivation"}, *derivation);
  }
}

void writeEvidence(Writer& root, const WrittenSegmentation& seg, const Series& source) {
  root.group(DCM_CurrentRequestedProcedureEvidenceSequence, [&](Writer& study) {
    study.text(DCM_StudyInstanceUID, source.studyUid);
    const auto series = [&](const std::string& uid, const std::string& sopClass,
                            const std::vector<std::string>& instances) {
      study.group(DCM_ReferencedSeriesSequence, [&](Writer& s) {
        s.text(DCM_SeriesInstanceUID, uid);
        for (const std::string& instance : instances)
          s.group(DCM_ReferencedSOPSequence, [&](Writer& w) {
            w.text(DCM_ReferencedSOPClassUID, sopClass);
            w.text(DCM_ReferencedSOPInstanceUID, instance);
          });
      });
    };
    series(seriesInstanceUid(source), source.sopClassUid, source.sopInstanceUids);
    series(seg.seriesInstanceUid, UID_SegmentationStorage, {seg.sopInstanceUid});
  });
}

}  // namespace

void writeMeasurementReport(const std::filesystem::path& file, const std::vector<ReportedStiffness>& regions,
                            StiffnessQuantity quantity, const WrittenSegmentation& segmentation, const Series& source,
                            std::uint64_t seed) {
  checkReferable(source, "a measurement report");
  if (regions.empty()) throw BadArgument("a measurement report needs at least one region");
  std::string identity = "sr/" + source.uid + "/" + std::to_string(seed) + "/" + segmentation.sopInstanceUid;
  for (const ReportedStiffness& r : regions)
    identity += "/" + r.name + std::to_string(r.n) + (std::isfinite(r.mean_kPa) ? decimalString(r.mean_kPa) : "");
  const bool shear = quantity == StiffnessQuantity::Shear;
  identity += shear ? "/mu" : "/E";
  DcmDataset image;
  readSourceHeader(source, image);
  DcmFileFormat format;
  DcmDataset& data = *format.getDataset();
  writeDerivedHeader(
      data, image, source,
      {UID_ComprehensiveSRStorage, "SR", "RESEARCH stiffness report", 9300 + source.number % 1000, identity, false});
  Writer root(data);
  Writer::check(data.insertEmptyElement(DCM_ReferencedPerformedProcedureStepSequence),
                DCM_ReferencedPerformedProcedureStepSequence);
  Writer::check(data.insertEmptyElement(DCM_PerformedProcedureCodeSequence), DCM_PerformedProcedureCodeSequence);
  root.text(DCM_CompletionFlag, "PARTIAL");
  root.text(DCM_CompletionFlagDescription, "Research use only, not for clinical use");
  root.text(DCM_VerificationFlag, "UNVERIFIED");
  writeCodingSchemes(data);
  writeEvidence(root, segmentation, source);
  root.text(DCM_ValueType, "CONTAINER");
  root.code(DCM_ConceptNameCodeSequence, {"126000", "DCM", "Imaging Measurement Report"});
  root.text(DCM_ContinuityOfContent, "SEPARATE");
  Item tree(data);
  tree.followsTemplate("1500");
  writeContext(tree);
  writeLibrary(tree, source);
  Item measurements = tree.container("CONTAINS", {"126010", "DCM", "Imaging Measurements"});
  for (const ReportedStiffness& r : regions)
    writeRegion(measurements, r, shear ? codes::shearModulus : codes::youngsModulus, segmentation, source, identity);
  saveDicom(format, file, EXS_LittleEndianExplicit);
}

}  // namespace glisson::dicom
