#include "pipeline/pictures.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "render/maps.h"

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
      if ((a - b).norm() <= largest) continue;
      largest = (a - b).norm();
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
    for (const int slice : options.slices) {
      map.slice = slice;
      write("difference-map-slice-" + std::to_string(slice) + ".png", render::differencePicture(scene, map));
    }
    return files;
  }
  const int largest = render::sliceOfLargestDifference(scene);
  plan("overlay-largest-difference.png", largest, {});
  if (data.vessel_lps_mm) plan("overlay-vessels.png", sliceOf(scene.mri.grid, *data.vessel_lps_mm), data.vessel_lps_mm);
  if (scene.retractorPoint_lps_mm)
    plan("overlay-retractor.png", sliceOf(scene.mri.grid, *scene.retractorPoint_lps_mm), {});
  drawPlanned();
  map.slice = largest;
  write("difference-map.png", render::differencePicture(scene, map));
  return files;
}

std::vector<std::filesystem::path> draw3D(const PictureData& data, const PictureOptions& options,
                                          const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!data.scene.valid) return files;
  render::SceneOptions3D o;
  o.palette = options.palette;
  o.width = options.width;
  o.height = options.height;
  const std::vector<NamedCamera> usual = {{"oblique", render::View3D::Oblique, {}},
                                          {"anterior", render::View3D::Anterior, {}}};
  for (const NamedCamera& camera : options.cameras.empty() ? usual : options.cameras) {
    o.view = camera.view;
    o.camera = camera.camera;
    const render::Picture picture = render::overlay3D(data.scene, o);
    files.push_back(folder / ("overlay-3d-" + camera.name + ".png"));
    render::writePng(files.back(), picture, options.dpi);
  }
  return files;
}

}  // namespace glisson::pipeline
