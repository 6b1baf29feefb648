// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/pictures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "render/colour_map.h"
#include "render/maps.h"
#include "render/overlays3d.h"

namespace glisson::pipeline {

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
      const float apart = p.compared ? (a - b).norm() : a.norm();
      if (apart <= largest) continue;
      largest = apart;
      place = at + 0.5 * (a + b).cast<double>();
    }
  return place;
}

namespace {

/// The slice that holds a point.
int sliceOf(const image::Grid& grid, const Eigen::Vector3d& p_lps) {
  return std::clamp(static_cast<int>(std::lround(grid.lpsToIndex(p_lps).z())), 0, grid.size.z() - 1);
}

/// A number that fills the text; nothing else counts.
std::optional<double> numberIn(const std::string& text) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace

NamedCamera cameraFromText(const std::string& text) {
  using render::View3D;
  static constexpr std::pair<const char*, View3D> names[] = {
      {"anterior", View3D::Anterior}, {"posterior", View3D::Posterior}, {"left", View3D::Left},
      {"right", View3D::Right},       {"superior", View3D::Superior},   {"inferior", View3D::Inferior},
      {"oblique", View3D::Oblique}};
  for (const auto& [name, view] : names)
    if (text == name) return {text, view, {}};
  const auto comma = text.find(',');
  if (comma != std::string::npos) {
    const auto azimuth = numberIn(text.substr(0, comma)), elevation = numberIn(text.substr(comma + 1));
    if (azimuth && elevation && std::abs(*elevation) <= 90.0 && std::abs(*azimuth) <= 360.0) {
      const auto part = [](double v) { return std::to_string(std::lround(v)); };
      return {"az" + part(*azimuth) + "-el" + part(*elevation), View3D::Oblique,
              render::Camera3D{*azimuth, *elevation}};
    }
  }
  throw BadInput("the camera \"" + text +
                 "\" is not known: give anterior, posterior, left, right, superior, inferior, oblique, or "
                 "azimuth,elevation in degrees (azimuth -360..360 from anterior to the left, elevation -90..90)");
}

std::vector<std::filesystem::path> drawSlices(const PictureData& data, const PictureOptions& options,
                                              const std::filesystem::path& folder) {
  const render::RetractionScene& scene = data.scene;
  std::vector<std::filesystem::path> files;
  if (!scene.valid) return files;
  render::SliceOverlayOptions o;
  o.palette = options.palette;
  o.margin_mm = 30.0;
  o.zoom_mm = 60.0;
  o.pixelsPerVoxel = std::clamp(static_cast<int>(std::lround(o.pixelsPerVoxel * options.width / 1600.0)), 1, 32);
  const auto write = [&](const std::string& name, const render::Picture& picture) {
    files.push_back(folder / name);
    render::writePng(files.back(), picture, options.dpi);
  };
  std::vector<std::string> names;
  std::vector<render::SliceOverlayOptions> overlays;
  const auto plan = [&](const std::string& name, int slice, const std::optional<Eigen::Vector3d>& zoom) {
    o.slice = slice;
    o.zoomCentre_lps_mm = zoom ? *zoom : placeOfLargestDifference(scene, slice);
    names.push_back(name);
    overlays.push_back(o);
  };
  const auto drawPlanned = [&] {
    const std::vector<render::Picture> pictures = render::sliceOverlays(scene, overlays);
    for (std::size_t n = 0; n < names.size(); ++n) write(names[n], pictures[n]);
  };
  render::MapOptions map{.high = 10.0};
  map.margin_mm = 30.0;
  map.pixelsPerVoxel = std::clamp(static_cast<int>(std::lround(map.pixelsPerVoxel * options.width / 1600.0)), 1, 32);
  if (!options.slices.empty()) {
    for (const int slice : options.slices) {
      if (slice < 0 || slice >= scene.mri.grid.size.z())
        throw BadInput("there is no slice " + std::to_string(slice) + ": the image has slices 0 to " +
                       std::to_string(scene.mri.grid.size.z() - 1));
      plan("overlay-slice-" + std::to_string(slice) + ".png", slice, {});
    }
    drawPlanned();
    if (!scene.compared) return files;
    for (const int slice : options.slices) {
      map.slice = slice;
      write("difference-map-slice-" + std::to_string(slice) + ".png", render::differencePicture(scene, map));
    }
    return files;
  }
  const int largest = render::sliceOfLargestDifference(scene);
  plan(scene.compared ? "overlay-largest-difference.png" : "overlay-largest-displacement.png", largest, {});
  if (data.vessel_lps_mm) plan("overlay-vessels.png", sliceOf(scene.mri.grid, *data.vessel_lps_mm), data.vessel_lps_mm);
  if (scene.retractorPoint_lps_mm)
    plan("overlay-retractor.png", sliceOf(scene.mri.grid, *scene.retractorPoint_lps_mm), {});
  drawPlanned();
  if (!scene.compared) return files;
  map.slice = largest;
  write("difference-map.png", render::differencePicture(scene, map));
  return files;
}

namespace {

/// The path of a bar, where it ends on the answer's own cells, and the largest force where it fell beyond it.
void addPath(const render::BarContact& c, const std::string& name, render::Rgb colour, render::XyChart& chart) {
  render::XyChart::Series path{.name = name, .markers = false, .colour = colour};
  for (const auto& [travel_mm, force_N] : c.path) {
    path.x.push_back(travel_mm);
    path.y.push_back(force_N);
  }
  chart.series.push_back(std::move(path));
  chart.series.push_back({.name = name + (c.slipped ? ", slips" : ", end"),
                          .x = {c.travel_mm},
                          .y = {c.force_N},
                          .joined = false,
                          .colour = colour});
  if (!c.capacityExceeded && !c.slipped) return;
  char label[64];
  std::snprintf(label, sizeof label, "capacity, %s: %.3g N", name.c_str(), c.capacity_N);
  chart.lines.push_back({c.capacity_N, label, render::colours::magenta});
}

}  // namespace

render::XyChart forceChart(const render::RigidBar& bar, const std::string& stiffness) {
  constexpr render::Rgb blue{0, 114, 178}, red{213, 94, 0};  // told apart by colour-blind readers too
  render::XyChart chart;
  chart.title = "Force of the bar against its travel";
  chart.x = {.title = "Travel from first touch (mm)", .low = 0.0};
  chart.y = {.title = "Force on the liver (N)", .low = 0.0};
  addPath(bar.mre, stiffness, blue, chart);
  if (bar.atlas) addPath(*bar.atlas, "atlas", red, chart);
  if (bar.asked_N > 0.0) {
    char label[48];
    std::snprintf(label, sizeof label, "asked for: %.3g N", bar.asked_N);
    chart.lines.push_back({bar.asked_N, label, render::colours::orange});
  }
  chart.caption = "Lines: on the coarse cells on which the way is followed. Points: the answers, on their own cells.";
  return chart;
}

std::vector<std::filesystem::path> drawCharts(const PictureData& data, const PictureOptions& options,
                                              const std::filesystem::path& folder) {
  if (!data.scene.bar || data.scene.bar->mre.path.empty()) return {};
  const std::filesystem::path file = folder / "force-travel.png";
  render::writePng(file, render::draw(forceChart(*data.scene.bar, data.scene.stiffness)), options.dpi);
  return {file};
}

std::vector<std::filesystem::path> draw3D(const PictureData& data, const PictureOptions& options,
                                          const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!data.scene.valid) return files;
  render::SceneOptions3D o;
  o.palette = options.palette;
  o.width = options.width;
  o.height = options.height;
  std::vector<std::string> names;
  std::vector<render::SceneOptions3D> pictures;
  const auto plan = [&](const std::string& name) {
    names.push_back(name);
    pictures.push_back(o);
  };
  const bool usual = options.cameras.empty();
  const std::vector<NamedCamera> usualCameras = {{"oblique", render::View3D::Oblique, {}},
                                                 {"anterior", render::View3D::Anterior, {}}};
  for (const NamedCamera& camera : usual ? usualCameras : options.cameras) {
    o.view = camera.view;
    o.camera = camera.camera;
    plan("overlay-3d-" + camera.name);
  }
  const std::vector<NamedCamera> behind = {{"", render::View3D::Posterior, render::barCamera}};
  for (const NamedCamera& camera : usual ? behind : options.cameras) {
    if (!data.scene.bar) break;
    o.view = camera.view;
    o.camera = camera.camera;
    const std::string name = camera.name.empty() ? std::string() : "-" + camera.name;
    o.shown = render::Shown3D::PressureMre;
    plan((data.scene.compared ? "contact-pressure-mre" : "contact-pressure") + name);
    if (!data.scene.bar->atlas) continue;
    o.shown = render::Shown3D::PressureAtlas;
    plan("contact-pressure-atlas" + name);
  }
  render::overlays3D(data.scene, pictures, [&](std::size_t n, const render::Picture& picture) {
    files.push_back(folder / (names[n] + ".png"));
    render::writePng(files.back(), picture, options.dpi);
  });
  return files;
}

}  // namespace glisson::pipeline
