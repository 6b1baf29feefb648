#include "pipeline/detail/outputs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include "anatomy/surface.h"
#include "base/error.h"
#include "image/extend.h"
#include "image/io.h"
#include "render/maps.h"
#include "report/html.h"

namespace glisson::pipeline::detail {
namespace {

using report::number;

/// How far the tissue around the liver follows it in the pictures; beyond, nothing moves.
constexpr double pictureMargin_mm = 40.0;

std::string inWords(const Eigen::Vector3d& v) {
  return number(v.x()) + ", " + number(v.y()) + ", " + number(v.z());
}

/// Something to warp where the scene has no image: the stiffness of the body, which is all that is known of it.
image::ScalarVolume stiffnessAsImage(const RunResult& r) {
  return r.model.youngs_kPa;
}

/// Where the two predictions differ most in a slice, in the middle between the two places; the middle of the image
/// where nothing moves.
Eigen::Vector3d placeOfLargestDifference(const render::RetractionScene& p, int slice) {
  const image::Grid& grid = p.u_mre_mm.grid;
  const image::Grid& mri = p.mri.grid;
  Eigen::Vector3d place = mri.indexToLps(0.5 * (mri.size - Eigen::Vector3i::Ones()).cast<double>());
  float largest = 0.0f;
  for (int j = 0; j < mri.size.y(); ++j)
    for (int i = 0; i < mri.size.x(); ++i) {
      const Eigen::Vector3d at = mri.indexToLps(Eigen::Vector3d(i, j, slice));
      const Eigen::Vector3i liver = p.liver.grid.lpsToIndex(at).array().round().cast<int>();
      const Eigen::Vector3i ijk = grid.lpsToIndex(at).array().round().cast<int>();
      if (!p.liver.grid.contains(liver) || !p.liver.at(liver) || !grid.contains(ijk)) continue;
      const Eigen::Vector3f a = p.u_mre_mm.at(ijk), b = p.u_atlas_mm.at(ijk);
      if ((a - b).norm() <= largest) continue;
      largest = (a - b).norm();
      place = at + 0.5 * (a + b).cast<double>();
    }
  return place;
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

/// The slice that holds a point.
int sliceOf(const image::Grid& grid, const Eigen::Vector3d& p_lps) {
  return std::clamp(static_cast<int>(std::lround(grid.lpsToIndex(p_lps).z())), 0, grid.size.z() - 1);
}

std::string caption(const Scene& scene, const RunResult& r) {
  const mechanics::SolveReport& s = r.primary.solver;
  std::string c = r.atlas ? "MRE against atlas stiffness, same load. " : "One stiffness. ";
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
  for (const retraction::LoadSpec& load : scene.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load)) {
      p.retractorAxis = bar->axis;
      p.retractorDirection = bar->direction;
      p.retractorDiameter_mm = bar->diameter_mm;
      p.retractorLength_mm = bar->length_mm;
    }
  p.clinicallySignificant_mm = defaults::clinicallySignificant.mm();
  p.caption = caption(scene, r);
  // A reservation is told in words; what may not be believed at all is not drawn.
  p.valid = r.primary.drawable && (!r.atlas || r.atlas->drawable);
  if (!r.primary.linearTrusted && !r.primary.validity.empty())
    p.mark = "MRE: " + r.primary.validity.front() + ".";
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
  const std::filesystem::path beside = file.string() + ".part";
  {
    std::ofstream out(beside, std::ios::binary);
    out << content;
    out.flush();
    if (!out) throw BadInput("cannot write '" + name + "'; is the disk full or the folder read-only?");
  }
  std::error_code ec;
  std::filesystem::rename(beside, file, ec);
  if (ec) throw BadInput("cannot write '" + name + "': " + ec.message());
}

void Writer::displacementFields(const RunResult& r) {
  image::writeVolume(note(r.atlas ? "displacement-mre.nrrd" : "displacement.nrrd"), r.primary.u_mm);
  if (r.atlas) image::writeVolume(note("displacement-atlas.nrrd"), r.atlas->u_mm);
}

void Writer::vessels(const Scene&, const RunResult& r, const anatomy::VesselModel& vessels) {
  report::Csv csv({"landmark", "x_mm", "y_mm", "z_mm", "radius_mm", "ux_mm", "uy_mm", "uz_mm", "difference_mm"});
  const auto u = retraction::displacementAt(r.model, r.primary, vessels.centreline_lps_mm);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Eigen::Vector3d& p = vessels.centreline_lps_mm[i];
    const double d = r.difference && i < r.difference->vessel_mm.size() ? r.difference->vessel_mm[i] : std::nan("");
    auto cell = [](double v) { return std::isfinite(v) ? number(v, 7) : std::string(); };
    csv.row({std::to_string(i), cell(p.x()), cell(p.y()), cell(p.z()), cell(vessels.radius_mm[i]), cell(u[i].x()),
             cell(u[i].y()), cell(u[i].z()), cell(d)});
  }
  text("vessels.csv", csv.text());
}

void Writer::stiffness(const elastography::Measurement& m) {
  report::Csv csv({"slice", "quantity", "n", "n_before_mask", "area_mm2", "mean_kPa", "median_kPa", "sd_kPa", "min_kPa",
                   "max_kPa"});
  const std::string quantity = m.quantity == StiffnessQuantity::Shear ? "shear" : "youngs";
  auto row = [&](const std::string& name, const elastography::Statistics& v) {
    csv.row({name, quantity, std::to_string(v.n), std::to_string(v.n_before_mask), number(v.area_mm2, 7),
             number(v.mean_kPa, 7), number(v.median_kPa, 7), number(v.sd_kPa, 7), number(v.min_kPa, 7),
             number(v.max_kPa, 7)});
  };
  for (const auto& slice : m.slices) row(std::to_string(slice.slice), slice.statistics);
  row("pooled", m.pooled);
  text("stiffness.csv", csv.text());
}

void Writer::sliceOverlays(const Scene&, const Inputs&, const RunResult& r, render::Palette palette) {
  if (!r.primary.drawable || (r.atlas && !r.atlas->drawable)) return;
  render::SliceOverlayOptions o;
  o.palette = palette;
  o.margin_mm = 30.0;
  o.zoom_mm = 60.0;
  auto draw = [&](const std::string& name, int slice) {
    o.slice = slice;
    if (!o.zoomCentre_lps_mm) o.zoomCentre_lps_mm = placeOfLargestDifference(*r.picture, slice);
    render::writePng(note(name), render::sliceOverlay(*r.picture, o));
    o.zoomCentre_lps_mm.reset();
  };
  const int largest = render::sliceOfLargestDifference(*r.picture);
  draw("overlay-largest-difference.png", largest);
  if (const std::optional<Eigen::Vector3d> vessel = mostMisplacedVessel(r)) {
    // Shown where it ends up, between the two predictions.
    const Eigen::Vector3d ua = retraction::displacementAt(r.model, r.primary, {*vessel}).front();
    const Eigen::Vector3d ub = r.atlas ? retraction::displacementAt(r.model, *r.atlas, {*vessel}).front() : ua;
    const Eigen::Vector3d moved = *vessel + 0.5 * (ua + ub);
    o.zoomCentre_lps_mm = moved;
    draw("overlay-vessels.png", sliceOf(r.picture->mri.grid, moved));
  }
  if (r.picture->retractorPoint_lps_mm)
    draw("overlay-retractor.png", sliceOf(r.picture->mri.grid, *r.picture->retractorPoint_lps_mm));
  render::MapOptions mapOptions{.high = 10.0};
  mapOptions.slice = largest;
  mapOptions.margin_mm = 30.0;
  render::writePng(note("difference-map.png"), render::differencePicture(*r.picture, mapOptions));
}

void Writer::overlays3D(const RunResult& r, render::Palette palette) {
  if (!r.primary.drawable || (r.atlas && !r.atlas->drawable)) return;
  render::SceneOptions3D o;
  o.palette = palette;
  const std::pair<const char*, render::View3D> views[] = {{"overlay-3d-oblique.png", render::View3D::Oblique},
                                                          {"overlay-3d-anterior.png", render::View3D::Anterior}};
  for (const auto& [name, view] : views) {
    o.view = view;
    render::writePng(note(name), render::overlay3D(*r.picture, o));
  }
}

void Writer::report(const Scene& scene, const RunResult& r) {
  report::HtmlReport page("Liver retraction, measured against textbook stiffness");
  page.heading("Result");
  std::vector<std::pair<std::string, std::string>> rows;
  if (r.difference) {
    const comparison::Difference& d = *r.difference;
    rows.emplace_back("Difference over the liver, mean", number(d.mean_mm) + " mm");
    rows.emplace_back("95 % of the liver below", number(d.p95_mm) + " mm");
    rows.emplace_back("Largest", number(d.max_mm) + " mm");
    rows.emplace_back("At the retractor",
                      number(d.at_retractor_mm) + " mm" +
                          (d.clinically_significant ? " (5 mm or more: clinically significant)" : ""));
    if (!d.vessel_mm.empty()) {
      rows.emplace_back("Vessel landmarks, mean", number(d.vesselMean_mm) + " mm");
      rows.emplace_back("Vessel landmarks 5 mm or more apart", number(100 * d.vesselFractionBeyond, 3) + " %");
    }
  }
  rows.emplace_back("Largest displacement", number(r.primary.max_displacement_mm) + " mm");
  if (r.stiffness) {
    const auto& s = r.stiffness->pooled;
    rows.emplace_back(
        r.stiffness->quantity == StiffnessQuantity::Shear ? "Shear modulus in the ROI" : "Young's modulus in the ROI",
        number(s.mean_kPa) + " ± " + number(s.sd_kPa) + " kPa (" + std::to_string(s.n_before_mask) + " voxels, " +
            std::to_string(s.n) + " after the confidence mask)");
  }
  page.table(rows);
  page.heading("Can it be trusted?");
  if (r.primary.linearTrusted)
    page.paragraph(r.primary.kinematics == retraction::Kinematics::Linear
                       ? "Strains and rotations are small enough for linear theory."
                       : "The large-deformation solve converged, and no cell is turned inside out.");
  page.list(r.primary.validity);
  page.table(
      {{"Solver", r.primary.solver.kind + ", relative residual " + number(r.primary.solver.residual, 2)},
       {"Strain, largest / 95 % below", number(r.primary.max_strain, 3) + " / " + number(r.primary.p95_strain, 3)},
       {"Largest rotation", number(r.primary.max_rotation_deg, 3) + " degrees"},
       {"Load", inWords(r.primary.load_N) + " N"},
       {"Reaction", inWords(r.primary.reaction_N) + " N"}});
  if (r.discretisation) page.paragraph(r.discretisation->note);
  page.list(r.warnings);
  page.heading("Pictures");
  for (const auto& f : r.files) {
    if (f.extension() != ".png") continue;
    const std::string name = f.filename().string();
    page.picture(
        f, name == "difference-map.png" ? "Distance between the two predictions, mm"
           : name.rfind("overlay-3d", 0) == 0
               ? "Vessels where the measured stiffness puts them (blue) and where the textbook stiffness does (red)"
               : "The image moved by each prediction: measured stiffness in blue, textbook in red, purple where they "
                 "agree");
  }
  page.heading("Method");
  page.table({{"Volume", number(r.model.volume_mL) + " mL"},
              {"Mass", number(r.model.mass_kg) + " kg"},
              {"Degrees of freedom", std::to_string(r.primary.dofs)},
              {"Poisson's ratio", number(scene.setup.poisson)},
              {"Density", number(scene.setup.density.kgPerM3()) + " kg/m³"}});
  text("report.html", page.html());
}

}  // namespace glisson::pipeline::detail
