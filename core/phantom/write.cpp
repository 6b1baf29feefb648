// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/quantity.h"
#include "dicom/rtstruct.h"
#include "dicom/write_mr.h"
#include "phantom/phantom.h"

namespace glisson::phantom {
namespace {

using Json = nlohmann::ordered_json;

constexpr int mriSeriesNumber = 4;
constexpr int mreSeriesNumber = 7;

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

Json truthOf(const PhantomPatient& patient) {
  const PhantomTruth& t = patient.truth;
  Json j;
  j["schema"] = "glisson/truth/1";
  j["shear_kPa"] = t.shear_kPa;
  j["whole_liver_shear_kPa"] = t.wholeLiverShear_kPa;
  j["noise_kPa"] = t.noise_kPa;
  j["volume_mL"] = t.volume_mL;
  j["mre_liver_voxels"] = t.liverVoxels;
  j["mre_confident_voxels"] = t.confidentVoxels;
  j["seed"] = t.seed;
  if (t.shape != LiverShape::Usual) j["shape"] = nameOf(t.shape);  // absent: usual
  j["vessels"] = Json::array();
  for (const VesselBranch& b : t.vessels) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : b.points_lps_mm)
      points.push_back({rounded(p.x(), 1e-3), rounded(p.y(), 1e-3), rounded(p.z(), 1e-3)});
    j["vessels"].push_back(
        {{"name", b.name}, {"parent", b.parent}, {"radius_mm", b.radius_mm}, {"points_lps_mm", points}});
  }
  return j;
}

Json sceneOf(const PhantomPatient& patient) {
  Json j;
  j["schema"] = "glisson/scene/1";
  j["geometry"] = {{"kind", "patient"}, {"mri", "mri"}, {"mre", "mre"}, {"roi", "rtstruct.dcm"}};
  j["material"] = "mre";
  j["supports"] = Json::array();
  for (const char* surface : {"posterior", "superior"})
    j["supports"].push_back({{"region", {{"surface", surface}}}, {"kind", "spring"}, {"stiffness_kPa_per_mm", 0.1}});
  j["loads"] = Json::array({{{"kind", "retractor"},
                             {"diameter_mm", defaults::retractorDiameter.mm()},
                             {"length_mm", 80},
                             {"at", "inferior-right-lobe"},
                             {"force", "liver-weight"},
                             {"direction", "transverse"}}});
  j["model"] = {{"kind", "fem-hex"}};
  j["compare"] = {{"against", "atlas"}};
  j["outputs"] = {"vessels", "overlay", "report"};
  j["seed"] = patient.number;
  return j;
}

// What every series of one patient shares.
struct Study {
  explicit Study(const PhantomPatient& patient);

  std::string uid(const char* of) const { return dicom::uidFrom(root + " " + of); }

  std::string root;  // what UIDs are made from
  dicom::MrSeriesHeader header;
};

Study::Study(const PhantomPatient& patient) {
  char number[16];
  std::snprintf(number, sizeof number, "%03d", patient.number);
  root = "glisson phantom " + std::to_string(patient.truth.seed) + " " + number;
  header.patientName = std::string("PHANTOM^") + number;
  header.patientId = std::string("PHANTOM-") + number;
  header.patientSex = "O";
  header.studyUid = uid("study");
  header.studyId = number;
  header.studyDescription = "ABDOMEN MR ELASTOGRAPHY";
  header.frameOfReferenceUid = uid("frame");
}

dicom::MrSeriesHeader mriHeader(const Study& study) {
  dicom::MrSeriesHeader mri = study.header;
  mri.seriesUid = study.uid("mri");
  mri.seriesNumber = mriSeriesNumber;
  mri.seriesDescription = "Ax LAVA +C PORTAL VENOUS";
  mri.sequenceVariant = "SS\\SP\\SK";
  mri.scanOptions = "FAST_GEMS\\FS";
  mri.acquisitionType = "3D";
  mri.pulseSequence = "efgre3d";
  mri.contrastAgent = "GADOLINIUM";
  mri.repetitionTime_ms = 3.6;
  mri.echoTime_ms = 1.7;
  mri.flipAngle_deg = 12.0;
  mri.windowCenter = 430.0;
  mri.windowWidth = 860.0;
  return mri;
}

// One map of the acquisition: its number among them, and how it is shown.
struct Map {
  const char* name;
  int offset;  // 0: the acquisition itself
  const char* description;
  const char* derivation;
  double windowCenter = 0.0, windowWidth = 0.0;
};

// One acquisition, and the maps the scanner makes of it: series n gives n·100 + 1, + 2, + 5 and + 7.
constexpr Map magnitudeMap{"magnitude", 0, "Ax MRE 60Hz", "", 200.0, 400.0};
constexpr Map stiffnessMap{"stiffness", 1, "Ax MRE 60Hz Stiffness (Pa)", "Shear stiffness in Pa", 4000.0, 8000.0};
constexpr Map waveMap{"wave",
                      5,
                      "Ax MRE 60Hz Wave",
                      "Shear wave image in radians = pixel * pi / (WindowWidth / 2)",
                      0.0,
                      PhantomPatient::waveWindowWidth};
constexpr Map confidenceMap{
    "confidence", 7, "Ax MRE 60Hz Confidence", "Confidence of the shear stiffness, 0 to 999", 500.0, 1000.0};
constexpr Map colourMap{"colour", 2, "Ax MRE 60Hz Colour Stiffness 0-8 kPa", "Colour picture of the shear stiffness"};

dicom::MrSeriesHeader headerOf(const Study& study, const Map& map) {
  dicom::MrSeriesHeader m = study.header;
  m.seriesUid = study.uid(map.name);
  m.seriesNumber = map.offset == 0 ? mreSeriesNumber : mreSeriesNumber * 100 + map.offset;
  m.seriesDescription = map.description;
  m.pulseSequence = "fgremre";
  m.derivation = map.derivation;
  if (map.offset != 0) m.imageType = {"DERIVED", "SECONDARY", "OTHER"};
  if (map.windowWidth > 0.0) {
    m.windowCenter = map.windowCenter;
    m.windowWidth = map.windowWidth;
  }
  return m;
}

void writeElastogram(const Study& study, const PhantomPatient& patient, const std::filesystem::path& folder) {
  const auto write = [&](const Map& map, const auto& volume) {
    dicom::writeMrSeries(folder / map.name, headerOf(study, map), volume);
  };
  write(magnitudeMap, patient.magnitude);
  write(stiffnessMap, patient.stiffness_Pa);
  write(waveMap, patient.wave);
  write(confidenceMap, patient.confidence);
  dicom::writeMrColourSeries(folder / colourMap.name, headerOf(study, colourMap), patient.colour);
}

// The written MRI as the outlines name it.
dicom::Series outlinedSeries(const dicom::MrSeriesHeader& mri, const dicom::WrittenSeries& images,
                             const image::Grid& grid) {
  dicom::Series source;
  source.uid = mri.seriesUid;
  source.studyUid = mri.studyUid;
  source.frameOfReferenceUid = mri.frameOfReferenceUid;
  source.modality = "MR";
  source.description = mri.seriesDescription;
  source.number = mri.seriesNumber;
  source.role = dicom::SeriesRole::Anatomical;
  source.roleReason = "The phantom's contrast-enhanced series.";
  source.files = images.files;
  source.sopInstanceUids = images.sopInstanceUids;
  source.sopClassUid = "1.2.840.10008.5.1.4.1.1.4";  // MR Image Storage
  source.grid = grid;
  return source;
}

dicom::StructureSet outlines(const PhantomPatient& patient, const dicom::Series& source) {
  dicom::StructureSet set;
  set.frameOfReferenceUid = source.frameOfReferenceUid;
  set.referencedSeriesUid = source.uid;
  dicom::Structure liver;
  liver.number = 1;
  liver.name = "liver";
  for (const roi::Polygon& p : patient.contours.polygons) {
    const auto k = static_cast<std::size_t>(std::lround(source.grid.lpsToIndex(p.points_lps_mm.col(0)).z()));
    liver.contours.push_back({p.points_lps_mm, source.sopInstanceUids.at(k)});
  }
  set.structures.push_back(std::move(liver));
  return set;
}

}  // namespace

void writePhantom(const PhantomPatient& patient, const std::filesystem::path& folder) {
  const Study study(patient);
  const dicom::MrSeriesHeader mri = mriHeader(study);
  const dicom::WrittenSeries images = dicom::writeMrSeries(folder / "mri", mri, patient.mri);
  writeElastogram(study, patient, folder / "mre");
  const dicom::Series source = outlinedSeries(mri, images, patient.mri.grid);
  dicom::writeRtStruct(folder / "rtstruct.dcm", outlines(patient, source), source, patient.truth.seed);
  writeAtomically(folder / "scene.json", sceneOf(patient).dump(2) + "\n");
  writeAtomically(folder / "truth.json", truthOf(patient).dump(1) + "\n");
}

}  // namespace glisson::phantom
