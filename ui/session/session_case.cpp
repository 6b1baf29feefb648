// The case on disk: contours.json, scene.json, and where the images are.
#include <fstream>

#include "base/error.h"
#include "dicom/rtstruct.h"
#include "elastography/roi_from_structures.h"
#include "image/io.h"
#include "roi/contour_io.h"
#include "roi/polygon.h"
#include "session/session.h"

namespace glisson::session {

namespace {

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path beside = file;
  beside += ".part";
  {
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.flush();
    if (!out)
      throw BadInput("cannot write '" + file.filename().string() + "': check the folder's rights and free space");
  }
  std::filesystem::rename(beside, file);
}

}  // namespace

pipeline::Scene Session::scene(const std::filesystem::path& folder) const {
  pipeline::Scene s;
  s.folder = folder;
  s.geometry.kind = pipeline::GeometrySpec::Kind::Patient;
  s.geometry.cell_mm.setConstant(parameters_.cell_mm);  // 0: the pipeline's default for the image
  s.geometry.roi = folder / "contours.json";
  s.material.kind =
      parameters_.useMre && images_.stiffness ? pipeline::MaterialSpec::Kind::Mre : pipeline::MaterialSpec::Kind::Atlas;
  s.setup.poisson = parameters_.poisson;
  s.setup.density = Density::fromKgPerM3(parameters_.density_kg_m3);
  s.setup.model.kind = parameters_.model;
  s.setup.model.meshfree.frames = parameters_.frames;
  for (const char* surface : {"posterior", "superior"}) {
    retraction::SupportSpec abdomen;
    abdomen.kind = retraction::SupportSpec::Kind::Spring;
    abdomen.region = retraction::SurfaceRegion{surface};
    abdomen.stiffness_kPa_per_mm = parameters_.abdomen_kPa_per_mm;
    s.setup.supports.push_back(abdomen);
  }
  retraction::Retractor retractor;
  retractor.diameter_mm = parameters_.retractorDiameter_mm;
  retractor.length_mm = parameters_.retractorLength_mm;
  retractor.spread_mm = parameters_.retractorSpread_mm;
  if (!parameters_.forceIsWeight) retractor.force_N = parameters_.force_N;
  s.setup.loads.push_back(retractor);
  s.compare = pipeline::CompareSpec{parameters_.atlasShear_kPa, StiffnessQuantity::Shear};
  s.outputs.vessels = s.outputs.overlay = true;
  return s;
}

CaseFiles Session::caseFiles(const std::filesystem::path& folder) const {
  return {images_, contours_, scene(folder)};
}

void writeCase(CaseFiles files, const std::filesystem::path& folder) {
  if (!files.images.mri) throw BadInput("there is nothing to save: open images first");
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  if (!std::filesystem::is_directory(folder))
    throw BadInput("cannot make the case folder; choose a place that can be written to");
  pipeline::Scene& s = files.scene;
  s.geometry.mri = files.images.mriSource;
  if (s.geometry.mri.empty()) {
    s.geometry.mri = folder / "mri.nrrd";
    image::writeVolume(s.geometry.mri, *files.images.mri);
  }
  if (files.images.stiffness) {
    if (files.images.mreSource.empty())
      throw BadInput(
          "the series of the elastogram were chosen by hand, and no folder holds just these: put stiffness and "
          "confidence into a folder of their own and open the patient again");
    s.geometry.mre = files.images.mreSource;
  }
  roi::writeContours(folder / "contours.json", files.contours);
  writeText(folder / "scene.json", pipeline::toJson(s));
}

void Session::saveCase(const QString& folder) {
  const std::filesystem::path target = folder.toStdString();
  writeCase(caseFiles(target), target);
  modified_ = false;
  emit statusChanged();
}

void Session::importContours(const QString& file) {
  if (!images_.mri) throw BadInput("open images first; outlines belong to an image series");
  const std::filesystem::path path = file.toStdString();
  roi::ContourStack imported;
  if (path.extension() == ".json") {
    imported = roi::readContours(path);
  } else if (image::isVolumeFile(path)) {
    imported = roi::contoursOf(image::readMask(path));
  } else {
    imported = elastography::roiFromStructures(dicom::readRtStruct(path));
  }
  imported.seriesUid = contours_.seriesUid;
  apply(tool_.state() == tools::ToolState::Drawing && plane_ ? tool_.leaveSlice(*plane_) : tools::Acts{});
  replaceContours(std::move(imported), "import outlines");
}

}  // namespace glisson::session
