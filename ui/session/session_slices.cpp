// SPDX-License-Identifier: GPL-3.0-or-later

// Marks of slices, what is still to be done, copies to other slices, and a second reader.
#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "commands/change_mark.h"
#include "commands/rename.h"
#include "commands/replace_contours.h"
#include "pipeline/case_folder.h"
#include "pipeline/sources.h"
#include "roi/agreement.h"
#include "roi/contour_io.h"
#include "session/imported_roi.h"
#include "session/session.h"
#include "tools/outline.h"

namespace glisson::session {

using commands::SliceMark;

namespace {

/// Whether one outline of this slice lies inside another.
bool liesIn(const roi::Polygon& one, const roi::Polygon& other, const tools::SlicePlane& plane) {
  const auto flat = [&plane](const roi::Polygon& p) {
    tools::Outline outline(2, p.points_lps_mm.cols());
    for (Eigen::Index i = 0; i < outline.cols(); ++i) outline.col(i) = plane.toPlane_mm(p.points_lps_mm.col(i));
    return outline;
  };
  const tools::Outline inner = flat(one), outer = flat(other);
  for (Eigen::Index i = 0; i < inner.cols(); ++i)
    if (!tools::inside(inner.col(i), outer)) return false;
  return true;
}

/// In how many regions of its slice an outline lies: a hole in an odd number of them.
int depthOf(const std::vector<roi::Polygon>& polygons, std::size_t index, const tools::SlicePlane& plane) {
  int depth = 0;
  for (std::size_t p = 0; p < polygons.size(); ++p)
    depth +=
        p != index && !polygons[p].exclude && plane.holds(polygons[p]) && liesIn(polygons[index], polygons[p], plane);
  return depth;
}

}  // namespace

Eigen::Vector3d Session::middleOf(int slice) const {
  const image::Grid& grid = images_.mri->grid;
  return grid.indexToLps({0.5 * grid.size.x(), 0.5 * grid.size.y(), 1.0 * slice});
}

std::optional<SliceMark> Session::markOf(int slice) const {
  const auto found = contours_.marks.find(slice);
  if (found == contours_.marks.end()) return std::nullopt;
  return found->second;
}

void Session::toggleMark(SliceMark mark) {
  if (!images_.mri || !plane_) return;
  const int k = plane_->slice;
  const bool off = markOf(k) == mark;
  if (!off && mark == SliceMark::NoLiver) {
    for (const roi::Polygon& p : contours_.polygons)
      if (p.points_lps_mm.cols() > 0 && tools::sliceOf(p, images_.mri->grid) == k) {
        emit message(tr("There is an outline on this slice: delete it before the slice is marked \"no liver\"."));
        return;
      }
    const OutlineCoverage c = coverage();
    if (c.empty.contains(k)) {
      emit message(tr("This slice lies between outlined ones and is filled by shape; it cannot be without liver."));
      return;
    }
  }
  undo_.push(
      std::make_unique<commands::ChangeMark>(contours_, k, off ? std::nullopt : std::optional(mark), middleOf(k)),
      contours_);
  contoursTouched();
}

std::optional<int> Session::nextPending(int after) const {
  if (!images_.mri) return std::nullopt;
  const OutlineCoverage c = coverage();
  const int n = images_.mri->grid.size.z();
  for (int step = 1; step <= n; ++step) {
    const int k = (after + step) % n;
    if (!c.drawn.contains(k) && !markOf(k)) return k;
  }
  return std::nullopt;
}

void Session::rename(const QString& name) {
  const std::string wanted = name.trimmed().toStdString();
  if (wanted.empty() || wanted == contours_.name || !images_.mri) return;
  const int slice = plane_ ? plane_->slice : 0;
  undo_.push(std::make_unique<commands::Rename>(contours_, wanted, middleOf(slice)), contours_);
  contoursTouched();
}

void Session::copyOutlines() {
  if (!plane_) return;
  std::vector<roi::Polygon> copied;
  const std::optional<std::size_t> selected = tool_.selected();
  const auto& there = contours_.polygons;
  if (selected && *selected < there.size()) {
    // A hole stays one wherever it is put, and a region takes its own along: left out, not by lying in each other.
    const int depth = depthOf(there, *selected, *plane_);
    copied.push_back(there[*selected]);
    if (depth % 2 == 1) copied.front().exclude = true;
    for (std::size_t p = 0; p < there.size() && !copied.front().exclude; ++p) {
      if (p == *selected || !plane_->holds(there[p]) || !liesIn(there[p], there[*selected], *plane_)) continue;
      if (!there[p].exclude && depthOf(there, p, *plane_) != depth + 1) continue;
      copied.push_back(there[p]);
      copied.back().exclude = true;
    }
  } else {
    std::copy_if(there.begin(), there.end(), std::back_inserter(copied),
                 [this](const roi::Polygon& p) { return plane_->holds(p); });
  }
  if (copied.empty()) {
    emit message(tr("There is no outline on this slice to copy."));
    return;
  }
  clipboard_ = std::move(copied);
  emit message(clipboard_.size() == 1 ? tr("Copied one outline.") : tr("Copied %1 outlines.").arg(clipboard_.size()));
}

void Session::pasteOutlines() {
  if (!plane_ || clipboard_.empty()) {
    emit message(tr("Copy an outline first (Ctrl+C)."));
    return;
  }
  apply(tool_.leaveSlice(*plane_));
  const std::size_t first = contours_.polygons.size();
  paste({plane_->slice}, roi::PolygonState::Draft, "paste outline");
  tool_.selectPolygon(first);
  tool_.selectAll(*plane_);
  toolMoved();
}

void Session::pasteBetween() {
  if (!plane_ || clipboard_.empty()) {
    emit message(tr("Copy an outline first (Ctrl+C)."));
    return;
  }
  const int source = tools::sliceOf(clipboard_.front(), images_.mri->grid);
  pasteTo(std::min(source, plane_->slice), std::max(source, plane_->slice));
}

void Session::pasteTo(int first, int last) {
  if (!images_.mri || clipboard_.empty()) return;
  const OutlineCoverage c = coverage();
  std::vector<int> slices;
  for (int k = std::max(first, 0); k <= std::min(last, images_.mri->grid.size.z() - 1); ++k)
    if (!c.drawn.contains(k) && !c.interpolated.contains(k) && !markOf(k)) slices.push_back(k);
  if (slices.empty()) {
    emit message(tr("There is no empty slice there."));
    return;
  }
  paste(slices, roi::PolygonState::Interpolated, "paste on empty slices");
  emit message(tr("Pasted on %1 slices. They count; accept, correct or redraw them.").arg(slices.size()));
}

void Session::paste(const std::vector<int>& slices, roi::PolygonState state, const char* text) {
  const image::Grid& grid = images_.mri->grid;
  const auto& sops = scan_.series[static_cast<std::size_t>(images_.mriSeries)].sopInstanceUids;
  roi::ContourStack after = contours_;
  for (const int k : slices)
    for (roi::Polygon copy : clipboard_) {
      const double along = k - grid.lpsToIndex(copy.points_lps_mm.rowwise().mean()).z();
      const Eigen::Vector3d shift = grid.direction.col(2) * (grid.spacing_mm.z() * along);
      copy.points_lps_mm.colwise() += shift;
      // What a region leaves out is settled with it: only the region itself is to be adjusted and accepted.
      const bool goesAlong = copy.exclude && !clipboard_.front().exclude;
      copy.state = goesAlong && state == roi::PolygonState::Draft ? roi::PolygonState::Accepted : state;
      copy.sopInstanceUid = static_cast<std::size_t>(k) < sops.size() ? sops[static_cast<std::size_t>(k)] : "";
      after.polygons.push_back(std::move(copy));
    }
  noteMade(after, commands::MadeBy::Copy);
  undo_.push(std::make_unique<commands::ReplaceContours>(contours_, std::move(after), text, middleOf(slices.back())),
             contours_);
  tool_.contoursChanged();
  contoursTouched();
}

void Session::setMeasureSettings(const MeasureSettings& settings) {
  if (settings == measure_) return;
  measure_ = settings;
  measure_.erosion_pixels = std::clamp(settings.erosion_pixels, 0, 50);
  settingsTouched();
  measureSoon();
  vesselTimer_.start();
  emit toolChanged();
  emit statusChanged();
}

void Session::loadSecondReader(const QString& file) {
  second_ = {};
  if (!file.isEmpty()) {
    if (!images_.mri) throw BadInput("open images first; outlines belong to an image series");
    const std::filesystem::path path = file.toStdString();
    pipeline::LoadedRoi roi;
    if (pipeline::isCase(path)) {
      roi.contours = roi::contoursFromJson(pipeline::readCase(path).contours, "contours.json");
      roi.frameOfReferenceUid = roi.contours->frameOfReferenceUid;
    } else {
      roi = pipeline::loadRoi(path, {}, 0);
    }
    const Belonging where = belongs(roi, scan_.series[static_cast<std::size_t>(images_.mriSeries)]);
    if (!where.refusal.isEmpty()) throw BadInput(where.refusal.toStdString());
    const QString said = QStringList{where.doubt, where.notes}.join(QLatin1Char(' ')).trimmed();
    if (!said.isEmpty()) emit message(said);
    if (!roi.contours) throw BadInput("a second reader's outlines are polygons: a contour file or RT Structure Set");
    second_ = std::move(*roi.contours);
  }
  emit contoursChanged();
  emit toolChanged();
}

void Session::compareReaders() {
  if (!images_.mri || second_.polygons.empty() || worker_.busy()) {
    emit message(worker_.busy() ? tr("Still at work; cancel it first.") : tr("Load a second reader's outlines first."));
    return;
  }
  work_ = Work::Readers;
  auto a = std::make_shared<roi::Agreement>();
  worker_.start(
      [a, first = static_cast<const roi::ContourStack&>(contours_), second = second_,
       mri = images_.mri](const Progress& progress) {
        const auto maskOf = [&mri](const roi::ContourStack& reader) {
          pipeline::LoadedRoi roi;
          roi.contours = reader;
          pipeline::completeOutlines(roi, mri->grid);
          return roi::rasterise(*roi.contours, mri->grid);
        };
        const image::Mask one = maskOf(first);
        progress.report(0.3, "comparing readers");
        *a = roi::agreement(one, maskOf(second));
      },
      [this, a](std::exception_ptr failure) {
        ended(Work::Readers, failure);
        if (failure) return;
        emit readersCompared(tr("Dice %1, Jaccard %2\nHausdorff %3 mm (95 %: %4 mm), mean distance %5 mm\n"
                                "Volume %6 mL against %7 mL, difference %8 mL (%9 %)")
                                 .arg(a->dice, 0, 'f', 3)
                                 .arg(a->jaccard, 0, 'f', 3)
                                 .arg(a->hausdorff_mm, 0, 'f', 1)
                                 .arg(a->hausdorff95_mm, 0, 'f', 1)
                                 .arg(a->meanSurfaceDistance_mm, 0, 'f', 2)
                                 .arg(a->volumeA_mL, 0, 'f', 0)
                                 .arg(a->volumeB_mL, 0, 'f', 0)
                                 .arg(a->volumeDifference_mL, 0, 'f', 0)
                                 .arg(a->volumeDifference_percent, 0, 'f', 1));
      });
  emit workStarted(tr("Comparing readers"));
  emit statusChanged();
}

}  // namespace glisson::session
