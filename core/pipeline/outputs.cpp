// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/outputs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "anatomy/surface.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/quantity_names.h"
#include "image/extend.h"
#include "image/io.h"
#include "pipeline/detail/uncertainty_record.h"
#include "pipeline/pictures.h"
#include "report/text.h"

namespace glisson::pipeline::detail {
namespace {

using report::number;

/// How far the tissue around the liver follows it in the pictures; beyond, nothing moves.
constexpr double pictureMargin_mm = 40.0;

/// Something to warp where the scene has no image: the stiffness of the body, which is all that is known of it.
image::ScalarVolume stiffnessAsImage(const RunResult& r) {
  return r.model.youngs_kPa;
}

/// The vessel landmark that the two predictions place furthest apart; none where there are no vessels.
std::optional<Eigen::Vector3d> mostMisplacedVessel(const RunResult& r) {
  if (!r.difference || r.difference->vessel_mm.size() != r.landmarks_mm.size()) return {};
  std::optional<Eigen::Vector3d> place;
  double largest = -1.0;
  for (std::size_t i = 0; i < r.landmarks_mm.size(); ++i)
    if (r.difference->vessel_mm[i] > largest) {
      largest = r.difference->vessel_mm[i];
      place = r.landmarks_mm[i];
    }
  return place;
}

/// What the scene's own stiffness is called beside, or without, the atlas.
std::string stiffnessName(const Scene& scene, bool compared) {
  switch (scene.material.kind) {
    case MaterialSpec::Kind::Mre: return "MRE";
    case MaterialSpec::Kind::Map: return "map";
    case MaterialSpec::Kind::Uniform: return "uniform";
    case MaterialSpec::Kind::Atlas: break;
  }
  return compared ? "own" : "atlas";
}

std::string caption(const Scene& scene, const RunResult& r, const std::string& name) {
  const mechanics::SolveReport& s = r.primary.solver;
  std::string c = r.atlas ? name + " against atlas stiffness, same load. " : "One stiffness (" + name + "). ";
  if (r.difference) {
    c += "Difference: mean " + number(r.difference->mean_mm, 3) + " mm, largest " + number(r.difference->max_mm, 3) +
         " mm";
    if (r.primary.retractorPoint_mm) c += ", at the retractor " + number(r.difference->at_retractor_mm, 3) + " mm";
    c += ". ";
  }
  c += std::to_string(r.primary.dofs) + " degrees of freedom, " + s.kind + ", Poisson's ratio " +
       number(scene.setup.poisson, 3) + ".";
  return c;
}

}  // namespace

render::RetractionScene retractionScene(const Scene& scene, const Inputs& inputs, const image::Mask& cells,
                                        const RunResult& r, const anatomy::VesselModel& vessels) {
  render::RetractionScene p;
  p.mri = inputs.mri ? *inputs.mri : stiffnessAsImage(r);
  p.liver = inputs.liver ? *inputs.liver : cells;
  p.u_mre_mm = image::extendHarmonically(r.primary.u_mm, cells, pictureMargin_mm);
  p.u_atlas_mm = r.atlas ? image::extendHarmonically(r.atlas->u_mm, cells, pictureMargin_mm) : p.u_mre_mm;
  p.liverSurface = anatomy::liverSurface(cells);
  p.vesselSurface = vessels.surface;
  p.retractorPoint_lps_mm = r.primary.retractorPoint_mm;
  p.bar = drawnBar(r, p.liverSurface);
  p.sure = howSureOf(r, vessels);
  for (const retraction::LoadSpec& load : scene.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load)) {
      p.retractorAxis = r.placed ? *r.placed->bar.axis : bar->patchAxis();
      p.retractorDirection = bar->direction;
      p.retractorDiameter_mm = bar->diameter_mm;
      p.retractorLength_mm = bar->length_mm;
    }
  p.clinicallySignificant_mm = defaults::clinicallySignificant.mm();
  p.compared = r.atlas.has_value();
  p.stiffness = stiffnessName(scene, p.compared);
  p.caption = caption(scene, r, p.stiffness);
  // A reservation is told in words; what may not be believed at all is not drawn.
  p.valid = r.primary.drawable && (!r.atlas || r.atlas->drawable);
  if (!r.primary.linearTrusted && !r.primary.validity.empty())
    p.mark = p.stiffness + ": " + r.primary.validity.front() + ".";
  else if (r.atlas && !r.atlas->linearTrusted && !r.atlas->validity.empty())
    p.mark = "Atlas: " + r.atlas->validity.front() + ".";
  return p;
}

Writer::Writer(std::filesystem::path folder, std::vector<std::filesystem::path>& files)
    : folder_(std::move(folder)), files_(files) {
  std::error_code ec;
  std::filesystem::create_directories(folder_, ec);
  if (ec || !std::filesystem::is_directory(folder_))
    throw BadInput("cannot make the output folder '" + folder_.filename().string() + "': " + ec.message() +
                   "; choose another with --output");
}

std::filesystem::path Writer::note(const std::string& name) {
  const std::filesystem::path file = folder_ / name;
  if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
  return file;
}

void Writer::text(const std::string& name, const std::string& content) {
  const std::filesystem::path file = note(name);
  writeAtomically(file, content);
}

void Writer::displacementFields(const RunResult& r) {
  // What is no answer says so in its name, wherever the file is taken.
  const auto name = [](const retraction::Result& one, const std::string& stem) {
    return stem + (one.solver.converged() ? ".nrrd" : "-not-converged.nrrd");
  };
  image::writeVolume(note(name(r.primary, r.atlas ? "displacement-mre" : "displacement")), r.primary.u_mm);
  if (r.atlas) image::writeVolume(note(name(*r.atlas, "displacement-atlas")), r.atlas->u_mm);
}

void Writer::vessels(const Scene&, const RunResult& r, const anatomy::VesselModel& vessels) {
  std::vector<std::string> head = {"landmark", "x_mm",  "y_mm",  "z_mm",         "radius_mm",
                                   "ux_mm",    "uy_mm", "uz_mm", "difference_mm"};
  const bool spread = r.uncertainty && r.uncertainty->known;
  if (spread) head.insert(head.end(), spreadColumns.begin(), spreadColumns.end());
  report::Csv csv(head);
  const auto u = retraction::displacementAt(r.model, r.primary, vessels.centreline_lps_mm);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Eigen::Vector3d& p = vessels.centreline_lps_mm[i];
    const double d = r.difference && i < r.difference->vessel_mm.size() ? r.difference->vessel_mm[i] : std::nan("");
    auto cell = [](double v) { return std::isfinite(v) ? number(v, 7) : std::string(); };
    std::vector<std::string> row = {
        std::to_string(i), cell(p.x()),    cell(p.y()),    cell(p.z()), cell(vessels.radius_mm[i]),
        cell(u[i].x()),    cell(u[i].y()), cell(u[i].z()), cell(d)};
    if (spread)
      for (const double v : spreadOf(*r.uncertainty, i)) row.push_back(cell(v));
    csv.row(row);
  }
  text("vessels.csv", csv.text());
}

void Writer::stiffness(const elastography::Measurement& m) {
  report::Csv csv({"slice", "quantity", "n", "n_before_mask", "area_mm2", "mean_kPa", "median_kPa", "sd_kPa", "min_kPa",
                   "max_kPa"});
  const std::string quantity = stiffnessQuantityNames.nameOf(m.quantity);
  auto row = [&](const std::string& name, const elastography::Statistics& v) {
    csv.row({name, quantity, std::to_string(v.n), std::to_string(v.n_before_mask), number(v.area_mm2, 7),
             number(v.mean_kPa, 7), number(v.median_kPa, 7), number(v.sd_kPa, 7), number(v.min_kPa, 7),
             number(v.max_kPa, 7)});
  };
  for (const auto& slice : m.slices) row(std::to_string(slice.slice), slice.statistics);
  row("pooled", m.pooled);
  text("stiffness.csv", csv.text());
}

PictureData Writer::pictureData(const RunResult& r) const {
  PictureData data{*r.picture, {}, sureNumbersOf(r)};
  if (const std::optional<Eigen::Vector3d> vessel = mostMisplacedVessel(r)) {
    // Shown where it ends up, between the two predictions.
    const Eigen::Vector3d ua = retraction::displacementAt(r.model, r.primary, {*vessel}).front();
    const Eigen::Vector3d ub = r.atlas ? retraction::displacementAt(r.model, *r.atlas, {*vessel}).front() : ua;
    data.vessel_lps_mm = *vessel + 0.5 * (ua + ub);
  }
  return data;
}

void Writer::pictureFile(const PictureData& data) {
  writePictureFile(note(pictureFileName), data);
}

void Writer::sliceOverlays(const PictureData& data, render::Palette palette) {
  for (const auto& file : drawSlices(data, {.palette = palette}, folder_)) files_.push_back(file);
}

void Writer::charts(const PictureData& data) {
  for (const auto& file : drawCharts(data, {}, folder_)) files_.push_back(file);
}

void Writer::overlays3D(const PictureData& data, render::Palette palette) {
  for (const auto& file : draw3D(data, {.palette = palette}, folder_)) files_.push_back(file);
}

void Writer::howSure(const PictureData& data, Language language) {
  for (const auto& file : drawHowSure(data, {.language = language}, folder_)) files_.push_back(file);
}

void Writer::howSure3D(const PictureData& data, render::Palette palette, Language language) {
  for (const auto& file : drawHowSure3D(data, {.palette = palette, .language = language}, folder_))
    files_.push_back(file);
}

}  // namespace glisson::pipeline::detail
