// SPDX-License-Identifier: GPL-3.0-or-later

// Pictures of how sure a run is.
#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "pipeline/pictures.h"
#include "render/colour_map.h"
#include "render/maps.h"
#include "uncertainty/surgeon.h"

namespace glisson::pipeline {
namespace {

using uncertainty::SourceSpread;

/// What a tornado is about.
struct About {
  double here_mm = 0.0;
  std::optional<uncertainty::Interval> all;
  std::optional<double> beyond;
  double SourceSpread::*sd = nullptr;
};

/// The line of 5 mm, and what is said below.
void compare(const About& about, Language language, render::Tornado& chart) {
  const std::string line = uncertainty::millimetres(defaults::clinicallySignificant.mm(), language);
  chart.lines = {{defaults::clinicallySignificant.mm(), phrase("clinically significant, @", language, {line}),
                  render::colours::orange}};
  chart.caption =
      phrase("Black line: the difference as computed, @. Chance that it is @ or more: @.", language,
             {uncertainty::millimetres(about.here_mm, language), line, uncertainty::percent(*about.beyond, language)}) +
      " " + chart.caption;
}

render::Tornado tornado(const char* title, const char* axis, const About& about, std::vector<SourceSpread> sources,
                        Language language) {
  std::stable_sort(sources.begin(), sources.end(),
                   [&](const SourceSpread& a, const SourceSpread& b) { return a.*about.sd > b.*about.sd; });
  render::Tornado chart;
  chart.title = phrase(title, language);
  chart.x.title = phrase(axis, language);
  chart.x.language = language;
  chart.here = about.here_mm;
  chart.caption = phrase("Blue: each source alone, ± one standard deviation.", language);
  for (const SourceSpread& s : sources) {
    const double sd = s.*about.sd;
    // A length has no negative half.
    chart.bars.push_back({uncertainty::labelOf(s.kind, language), std::max(0.0, about.here_mm - sd), about.here_mm + sd,
                          "± " + uncertainty::millimetres(sd, language)});
  }
  if (about.all)
    chart.bars.push_back({phrase("all together, 95 %", language), about.all->low, about.all->high,
                          uncertainty::rangeOf(*about.all, language), true});
  if (about.beyond) compare(about, language, chart);
  return chart;
}

}  // namespace

std::optional<SureNumbers> sureNumbersOf(const RunResult& r) {
  if (!r.uncertainty || !r.uncertainty->known) return {};
  SureNumbers n;
  n.headline = r.uncertainty->spread.headline;
  if (n.headline) n.at_retractor_mm = r.difference->at_retractor_mm;
  n.vessels = !r.uncertainty->spread.landmarks.empty();
  n.sources = r.uncertainty->spread.sources;
  return n;
}

std::optional<render::Tornado> retractorTornado(const SureNumbers& n, Language language) {
  if (!n.headline) return {};
  return tornado("What the difference at the retractor depends on",
                 "Difference at the retractor, measured against textbook stiffness (mm)",
                 {n.at_retractor_mm, n.headline->at_retractor_mm, n.headline->beyond, &SourceSpread::sd_mm}, n.sources,
                 language);
}

std::optional<render::Tornado> vesselTornado(const SureNumbers& n, Language language) {
  if (!n.vessels) return {};
  if (!n.headline)
    return tornado("What the vessels' places depend on", "Root mean square over the vessels (mm)",
                   {0.0, {}, {}, &SourceSpread::vessels_sd_mm}, n.sources, language);
  const uncertainty::VesselHeadline& v = *n.headline->vessels;
  return tornado("What the largest difference of a vessel depends on", "Difference at the vessel furthest apart (mm)",
                 {v.furthest_mm, v.furthest95_mm, v.furthestBeyond, &SourceSpread::furthest_sd_mm}, n.sources,
                 language);
}

std::vector<std::filesystem::path> drawHowSure(const PictureData& data, const PictureOptions& options,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!data.sure || !data.scene.valid) return files;
  const auto write = [&](const std::string& name, const render::Picture& picture) {
    files.push_back(folder / name);
    render::writePng(files.back(), picture, options.dpi);
  };
  if (options.slices.empty()) {
    if (const auto chart = retractorTornado(*data.sure, options.language))
      write("tornado-retractor.png", render::draw(*chart));
    if (const auto chart = vesselTornado(*data.sure, options.language))
      write("tornado-vessel.png", render::draw(*chart));
  }
  if (!data.scene.sure || data.scene.sure->beyond.values.empty()) return files;
  render::MapOptions map;
  map.language = options.language;
  map.margin_mm = 30.0;
  map.pixelsPerVoxel = std::clamp(static_cast<int>(std::lround(map.pixelsPerVoxel * options.width / 1600.0)), 1, 32);
  if (options.slices.empty()) write("probability-map.png", render::probabilityPicture(data.scene, map));
  for (const int slice : options.slices) {
    map.slice = slice;
    write("probability-map-slice-" + std::to_string(slice) + ".png", render::probabilityPicture(data.scene, map));
  }
  return files;
}

std::vector<std::filesystem::path> drawHowSure3D(const PictureData& data, const PictureOptions& options,
                                                 const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!data.scene.valid || !data.scene.sure || data.scene.sure->vessel95_mm.size() == 0) return files;
  render::SceneOptions3D o;
  o.shown = render::Shown3D::HowSure;
  o.language = options.language;
  o.palette = options.palette;
  o.width = options.width;
  o.height = options.height;
  const std::vector<NamedCamera> usual = {{"", render::View3D::Anterior, {}}};
  for (const NamedCamera& camera : options.cameras.empty() ? usual : options.cameras) {
    o.view = camera.view;
    o.camera = camera.camera;
    files.push_back(folder / ("how-sure-3d" + (camera.name.empty() ? "" : "-" + camera.name) + ".png"));
    render::writePng(files.back(), render::overlay3D(data.scene, o), options.dpi);
  }
  return files;
}

}  // namespace glisson::pipeline
