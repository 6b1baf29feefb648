// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "anatomy/surface.h"
#include "base/error.h"
#include "elastography/statistics.h"
#include "exchange/markups.h"
#include "exchange/mesh_files.h"
#include "exchange/seg_nrrd.h"
#include "exchange/slicer_scene.h"
#include "exchange/sofa.h"
#include "exchange/system_matrices.h"
#include "exchange/text_file.h"
#include "exchange/tidy_csv.h"
#include "image/io.h"
#include "pipeline/detail/export_case.h"
#include "roi/contour_io.h"

namespace glisson::pipeline::detail {
namespace {

image::Mask cellsOf(const retraction::Model& model) {
  image::Mask cells(model.youngs_kPa.grid);
  for (std::size_t n = 0; n < cells.values.size(); ++n) cells.values[n] = model.youngs_kPa.values[n] > 0.0f ? 1 : 0;
  return cells;
}

/// Smooth surface at rest and where a result puts it, both with the displacement at their vertices.
void writeSurfaces(ExportCase& c, const std::string& rest, const std::string& moved) {
  const RunResult& r = c.result();
  anatomy::TriangleMesh surface = anatomy::liverSurface(cellsOf(r.model));
  const exchange::NamedArray u{"u_mm", exchange::displacementsNear(r.model, r.primary, surface.vertices_lps_mm)};
  exchange::writeVtp(c.file(rest), surface, {u});
  surface.vertices_lps_mm += u.values;
  exchange::writeVtp(c.file(moved), surface, {u});
}

void addStatistics(std::vector<exchange::TidyRow>& rows, const ExportRequest& request, const std::string& slice,
                   const std::string& quantity, const elastography::Statistics& s) {
  const auto add = [&](const char* statistic, double value, const char* unit) {
    rows.push_back({request.caseName, request.reader, slice, "liver", quantity, statistic, value, unit});
  };
  add("n", static_cast<double>(s.n), "voxel");
  add("n_before_mask", static_cast<double>(s.n_before_mask), "voxel");
  add("area", s.area_mm2, "mm2");
  add("mean", s.mean_kPa, "kPa");
  add("median", s.median_kPa, "kPa");
  add("sd", s.sd_kPa, "kPa");
  add("min", s.min_kPa, "kPa");
  add("max", s.max_kPa, "kPa");
}

}  // namespace

void exportContours(ExportCase& c) {
  roi::ContourStack contours = c.contours();
  contours.name = "liver";
  roi::writeContours(c.file("contours.json"), contours);
}

void exportMarkups(ExportCase& c) {
  exchange::writeTextFile(c.file("contours.mrk.json"), exchange::contoursToMarkups(c.contours()));
}

void exportNifti(ExportCase& c) {
  image::writeVolume(c.file("liver.nii.gz"), c.liver());
}

void exportSegNrrd(ExportCase& c) {
  exchange::writeSegNrrd(c.file("liver.seg.nrrd"), {{"liver", c.liver()}});
}

void exportField(ExportCase& c) {
  const RunResult& r = c.result();
  image::writeVolume(c.file(r.atlas ? "displacement-mre.nrrd" : "displacement.nrrd"), r.primary.u_mm);
  if (r.atlas) image::writeVolume(c.file("displacement-atlas.nrrd"), r.atlas->u_mm);
}

void exportVtu(ExportCase& c) {
  const RunResult& r = c.result();
  exchange::HexMesh body = exchange::hexMeshOf(r.model, &r.primary);
  if (r.atlas) {
    const exchange::HexMesh atlas = exchange::hexMeshOf(r.model, &*r.atlas);
    body.pointArrays.push_back({"u_atlas_mm", atlas.pointArrays.front().values});
  }
  exchange::writeVtu(c.file("body.vtu"), body);
  exchange::writeVtu(c.file("body-deformed.vtu"), exchange::deformed(body));
  writeSurfaces(c, "surface.vtp", "surface-deformed.vtp");
  const double end_s = c.scene().setup.analysis.dynamic ? c.scene().setup.analysis.end_s : 1.0;
  exchange::writePvd(c.file("body.pvd"), {{0.0, "body.vtu"}, {end_s, "body-deformed.vtu"}});
  exchange::writePvd(c.file("surface.pvd"), {{0.0, "surface.vtp"}, {end_s, "surface-deformed.vtp"}});
}

void exportMatrices(ExportCase& c) {
  // Assembled of the model as it is solved; the solve itself is not needed, but cells and moduli are.
  c.note(exchange::writeSystem(c.request().output, c.result().model, c.scene().setup));
  c.warn(retraction::notExportable(c.scene().setup));
}

void exportCsv(ExportCase& c) {
  std::vector<exchange::TidyRow> rows;
  const ExportRequest& request = c.request();
  if (!c.scene().geometry.mre.empty()) {
    elastography::MeasureOptions options;
    options.poisson = c.scene().setup.poisson;
    const elastography::Measurement m = elastography::measure(c.stiffness(), c.liverOnMre(), options);
    const std::string quantity = m.quantity == StiffnessQuantity::Shear ? "shear modulus" : "Young's modulus";
    for (const elastography::SliceStatistics& s : m.slices)
      addStatistics(rows, request, std::to_string(s.slice + 1), quantity, s.statistics);
    addStatistics(rows, request, "pooled", quantity, m.pooled);
  }
  const RunResult& r = c.result();
  const auto add = [&](const char* quantity, const char* statistic, double value, const char* unit) {
    rows.push_back({request.caseName, request.reader, "all", "liver", quantity, statistic, value, unit});
  };
  add("volume", "total", r.model.volume_mL, "mL");
  add("displacement", "max", r.primary.max_displacement_mm, "mm");
  add("strain", "p95", r.primary.p95_strain, "1");
  add("strain", "max", r.primary.max_strain, "1");
  if (r.difference) {
    add("difference to atlas", "mean", r.difference->mean_mm, "mm");
    add("difference to atlas", "p95", r.difference->p95_mm, "mm");
    add("difference to atlas", "max", r.difference->max_mm, "mm");
    if (r.primary.retractorPoint_mm) add("difference to atlas", "at retractor", r.difference->at_retractor_mm, "mm");
  }
  exchange::writeTextFile(c.file("measurements.csv"), exchange::tidyCsv(rows));
}

void exportSlicer(ExportCase& c) {
  using Kind = exchange::SlicerItem::Kind;
  std::vector<exchange::SlicerItem> items;
  const GeometrySpec& g = c.scene().geometry;
  if (g.kind == GeometrySpec::Kind::Patient) {
    image::writeVolume(c.file("mri.nrrd"), loadImage(g.mri, {}, g.roles, c.roi().names).volume);
    items.push_back({Kind::Volume, "MRI", "mri.nrrd"});
  }
  if (g.kind != GeometrySpec::Kind::Box) {
    exportSegNrrd(c);
    items.push_back({Kind::Segmentation, "liver", "liver.seg.nrrd"});
    exportMarkups(c);
    items.push_back({Kind::ClosedCurves, "contours", "contours.mrk.json"});
  }
  writeSurfaces(c, "surface.vtp", "surface-deformed.vtp");
  items.push_back({Kind::Model, "liver at rest", "surface.vtp", 0.87, 0.72, 0.45, 0.35});
  items.push_back({Kind::Model, "liver retracted", "surface-deformed.vtp", 0.25, 0.35, 0.85, 0.6});
  exportField(c);
  items.push_back(
      {Kind::VectorVolume, "displacement", c.result().atlas ? "displacement-mre.nrrd" : "displacement.nrrd"});
  exchange::writeSlicerScene(c.file("scene.mrml"), items);
}

void exportSofa(ExportCase& c) {
  const RunResult& r = c.result();
  exchange::SofaLandmarks landmarks;
  landmarks.points_lps_mm = r.landmarks_mm;
  const exchange::SofaExport written = exchange::writeSofa(c.request().output, r.model, c.scene().setup, landmarks);
  c.note(written.files);
  for (const std::string& n : written.notes) c.warn(n);
  c.warn(retraction::notExportable(c.scene().setup));
}

}  // namespace glisson::pipeline::detail
