// SPDX-License-Identifier: GPL-3.0-or-later

// The live readout: stiffness first, by a worker; the region and its volume follow once the hand rests.
#include <algorithm>
#include <cmath>
#include <utility>

#include "anatomy/vessels.h"
#include "base/error.h"
#include "elastography/roi_mapping.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "pipeline/sources.h"
#include "session/measured_contours.h"
#include "session/session.h"

namespace glisson::session {

namespace {

/// The region that counts, as a run takes it: empty slices between outlines are filled by shape. Null where none
/// counts.
std::shared_ptr<const image::Mask> regionOf(const commands::Outlines& counted, const image::Grid& grid) {
  pipeline::LoadedRoi roi;
  roi.contours = counted;
  try {
    pipeline::completeOutlines(roi, grid);
    return std::make_shared<const image::Mask>(roi::rasterise(*roi.contours, grid));
  } catch (const BadInput&) {
    return nullptr;  // statistics say why
  }
}

/// What the border of the inner region is drawn of.
image::Mask withoutVessels(image::Mask region, const std::shared_ptr<const image::Mask>& vessels) {
  if (vessels && vessels->grid.sameGeometry(region.grid))
    for (std::size_t v = 0; v < region.values.size(); ++v)
      if (vessels->values[v] != 0) region.values[v] = 0;
  return region;
}

double volumeOf_mL(const image::Mask& region) {
  const auto inside = std::count_if(region.values.begin(), region.values.end(), [](auto v) { return v != 0; });
  return 1e-3 * static_cast<double>(inside) * region.grid.voxelVolume_mm3();
}

struct Measured {
  std::optional<elastography::Measurement> pooled;
  QString reason;
  bool rimKept = false;
  std::shared_ptr<const image::Mask> inner;
};

/// As a run and the command line measure: empty slices between outlines are interpolated.
void measureInto(Measured& now, const commands::Outlines& counted, const OpenImages& images,
                 const MeasureSettings& settings, const std::shared_ptr<const image::Mask>& vessels) {
  try {
    pipeline::LoadedRoi roi;
    roi.contours = measuredContours(counted, images.mri->grid, images.stiffness->values_kPa.grid);
    const elastography::MappedRoi mapped = pipeline::mapRoi(roi, images.mri->grid, *images.stiffness);
    elastography::MeasureOptions options;
    if (settings.innerRoi) {
      image::Mask inner = image::erodeInPlane(mapped.mask, settings.erosion_pixels);
      now.rimKept = image::count(inner) == 0;
      options.erosion_pixels = now.rimKept ? 0 : settings.erosion_pixels;
      if (!now.rimKept) now.inner = std::make_shared<image::Mask>(withoutVessels(std::move(inner), vessels));
    }
    if (vessels && vessels->grid.sameGeometry(mapped.mask.grid)) options.exclude = vessels.get();
    now.pooled = elastography::measure(*images.stiffness, mapped.mask, options);
  } catch (const Error& none) {
    now.reason = QString::fromUtf8(none.what());
  }
}

}  // namespace

// A closed outline that is being adjusted counts in the live readout, though it is not accepted yet; so does the one
// that is being drawn.
commands::Outlines Session::countedNow() const {
  commands::Outlines counted = contours_;
  if (tool_.preview().cols() > 0 && tool_.selected())
    counted.polygons[*tool_.selected()].points_lps_mm = tool_.preview();
  if (tool_.drawing().cols() >= 3) {
    roi::Polygon inWork;
    inWork.points_lps_mm = tool_.outlineInWork();
    counted.polygons.push_back(std::move(inWork));
  }
  if (tool_.state() == tools::ToolState::Editing && tool_.selected() && *tool_.selected() < counted.polygons.size())
    counted.polygons[*tool_.selected()].state = roi::PolygonState::Accepted;
  return counted;
}

void Session::measureSoon() {
  if (!measureTimer_.isActive()) measureTimer_.start();
}

std::optional<int> Session::mapSliceShown() const {
  if (!plane_ || !images_.stiffness) return std::nullopt;
  const Eigen::Vector3d centre =
      plane_->grid.indexToLps({0.5 * plane_->grid.size.x(), 0.5 * plane_->grid.size.y(), 1.0 * plane_->slice});
  return static_cast<int>(std::lround(images_.stiffness->values_kPa.grid.lpsToIndex(centre).z()));
}

void Session::pickSlice() {
  statistics_.slice.reset();
  const std::optional<int> shown = mapSliceShown();
  if (!shown || !statistics_.pooled) return;
  for (const elastography::SliceStatistics& s : statistics_.pooled->slices)
    if (s.slice == *shown) statistics_.slice = s.statistics;
}

void Session::measure() {
  if (measurer_.busy()) {
    measureAgain_ = true;
    return;
  }
  const commands::Outlines counted = countedNow();
  const bool any = images_.mri && std::any_of(counted.polygons.begin(), counted.polygons.end(),
                                              [](const auto& p) { return p.state != roi::PolygonState::Draft; });
  if (!any) {
    statistics_ = {};
    statistics_.reason = images_.stiffness ? tr("Draw an outline to measure.") : tr("No elastogram is open.");
    emit statisticsChanged();
    return;
  }
  // Another slice has another readout of the same measurement and the same region.
  const RegionKey key{revision_, tool_.state(), tool_.selected()};
  const bool inWork = tool_.preview().cols() > 0 || tool_.drawing().cols() >= 3;
  measuredKey_ = inWork ? std::nullopt : std::optional(key);
  if (!images_.stiffness) {
    statistics_.pooled.reset();
    statistics_.slice.reset();
    statistics_.reason = tr("No elastogram is open.");
    emit statisticsChanged();
    regionTimer_.start();
    return;
  }
  auto now = std::make_shared<Measured>();
  measurer_.start(
      [now, counted, images = images_, settings = measure_, vessels = measure_.vessels ? vessels_ : nullptr](
          const Progress&) { measureInto(*now, counted, images, settings, vessels); },
      [this, now](std::exception_ptr failure) {
        statistics_.pooled = std::move(now->pooled);
        statistics_.reason = failure ? reasonOf(failure) : now->reason;
        statistics_.rimKept = now->rimKept;
        inner_ = now->inner;
        pickSlice();
        emit statisticsChanged();
        regionTimer_.start();
        if (std::exchange(measureAgain_, false)) measure();
      });
}

// By a worker of its own: the readout does not wait for it.
void Session::measureRegion() {
  if (!images_.mri || (statistics_.region && measuredKey_ && measuredKey_ == regionKey_)) return;
  if (regioner_.busy()) {
    regionTimer_.start();
    return;
  }
  auto region = std::make_shared<std::shared_ptr<const image::Mask>>();
  auto volume_mL = std::make_shared<double>(0.0);
  regioner_.start(
      [region, volume_mL, counted = countedNow(), mri = images_.mri](const Progress&) {
        *region = regionOf(counted, mri->grid);
        if (*region) *volume_mL = volumeOf_mL(**region);
      },
      [this, region, volume_mL, mri = images_.mri, key = measuredKey_](std::exception_ptr) {
        if (mri != images_.mri) return;  // of the patient before
        statistics_.region = std::move(*region);
        statistics_.volume_mL = *volume_mL;
        regionKey_ = key;
        emit statisticsChanged();
        vesselTimer_.start();
      });
}

// Vessels lie where they lie: those that were found count until the outlines rest and they are looked for again.
void Session::findVessels() {
  constexpr double least_mL = 200.0;  // of a liver: less holds no tree of vessels to be told from its background
  const auto region = statistics_.region;
  if (!measure_.vessels || !images_.mri || !images_.stiffness || !region || region == vesselsOf_ ||
      statistics_.volume_mL < least_mL)
    return;
  if (worker_.busy() || vesseler_.busy()) {  // not beside a run
    vesselTimer_.start();
    return;
  }
  auto found = std::make_shared<std::shared_ptr<const image::Mask>>();
  vesseler_.start(
      [found, region, mri = images_.mri, map = images_.stiffness](const Progress& progress) {
        const anatomy::VesselModel vessels = anatomy::findVessels(*mri, *region, progress);
        *found = std::make_shared<const image::Mask>(image::resampleNearest(vessels.mask, map->values_kPa.grid));
      },
      [this, found, region, mri = images_.mri, map = images_.stiffness](std::exception_ptr failure) {
        if (failure || mri != images_.mri || map != images_.stiffness) return;
        vesselsOf_ = region;
        vessels_ = std::move(*found);
        measure();
      });
}

}  // namespace glisson::session
