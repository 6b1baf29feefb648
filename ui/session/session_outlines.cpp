// SPDX-License-Identifier: GPL-3.0-or-later

// Interpolating between drawn slices, and accepting what was interpolated.
#include "base/error.h"
#include "commands/replace_contours.h"
#include "roi/interpolate.h"
#include "roi/polygon.h"
#include "roi/propose.h"
#include "session/session.h"

namespace glisson::session {

OutlineCoverage Session::coverage() const {
  return images_.mri ? coverageOf(contours_, images_.mri->grid) : OutlineCoverage{};
}

void Session::interpolateOutlines() {
  if (worker_.busy()) {
    emit message(tr("Still at work; cancel it first."));
    return;
  }
  if (!images_.mri || coverage().drawn.size() < 2) {
    emit message(tr("Outline the liver on two slices at least, and accept these outlines (Enter)."));
    return;
  }
  // What was interpolated before is made anew from the outlines as they are now; proposals and copies stay.
  auto full = std::make_shared<roi::ContourStack>(contours_);
  std::erase_if(full->polygons, [this](const auto& p) {
    return p.state == roi::PolygonState::Interpolated &&
           contours_.madeBy(p).value_or(commands::MadeBy::Interpolation) == commands::MadeBy::Interpolation;
  });
  const std::uint64_t revision = revision_;
  work_ = Work::Interpolate;
  worker_.start(
      [full, mri = images_.mri](const Progress&) { *full = roi::interpolateBetween(*full, mri->grid); },
      [this, full, revision](std::exception_ptr failure) {
        ended(Work::Interpolate, failure);
        if (failure) return;
        if (revision != revision_) {
          emit message(tr("The outlines changed meanwhile; interpolate again."));
          return;
        }
        if (std::none_of(full->polygons.begin(), full->polygons.end(),
                         [](const auto& p) { return p.state == roi::PolygonState::Interpolated; })) {
          emit message(tr("There is no empty slice between outlines that overlap."));
          return;
        }
        noteMade(*full, commands::MadeBy::Interpolation);
        replaceContours(std::move(*full), "interpolate between slices");
        const OutlineCoverage now = coverage();
        emit message(
            tr("%1 slices were interpolated between %2 drawn ones. They count; accept, correct or redraw them.")
                .arg(now.interpolated.size())
                .arg(now.drawn.size()));
      });
  emit workStarted(tr("Interpolating"));
  emit statusChanged();
}

void Session::propose(const Eigen::Vector3d& seed_lps) {
  if (worker_.busy() || !images_.mri) {
    if (worker_.busy()) emit message(tr("Still at work; cancel it first."));
    return;
  }
  if (plane_) apply(tool_.leaveSlice(*plane_));
  constexpr double smooth = 0.6;  // of a pixel: steps of voxels become lines
  auto full = std::make_shared<roi::ContourStack>(contours_);
  auto leaked = std::make_shared<bool>(false);
  auto notes = std::make_shared<QString>();
  const std::uint64_t revision = revision_;
  work_ = Work::Propose;
  worker_.start(
      [full, leaked, notes, seed_lps, mri = images_.mri, outlines = contours_,
       sops = scan_.series[static_cast<std::size_t>(images_.mriSeries)].sopInstanceUids](const Progress& progress) {
        const roi::Proposal proposal = roi::propose(*mri, seed_lps, {}, progress);
        *leaked = proposal.touchesBorder;
        for (const std::string& note : proposal.notes) *notes += " (" + QString::fromStdString(note) + ")";
        std::erase_if(full->polygons, [&outlines](const auto& p) {
          return p.state == roi::PolygonState::Interpolated && outlines.madeBy(p) != commands::MadeBy::Copy;
        });
        const OutlineCoverage kept = coverageOf(*full, mri->grid);
        std::set<int> drawn = kept.drawn;
        drawn.insert(kept.interpolated.begin(), kept.interpolated.end());
        for (roi::Polygon& p : roi::contoursOf(proposal.mask).polygons) {
          const int k = tools::sliceOf(p, mri->grid);
          if (drawn.contains(k)) continue;
          roi::Polygon line = roi::simplified(p, smooth * mri->grid.spacing_mm.head<2>().minCoeff());
          if (roi::refusal(line, mri->grid)) continue;
          line.state = roi::PolygonState::Interpolated;
          if (k >= 0 && static_cast<std::size_t>(k) < sops.size())
            line.sopInstanceUid = sops[static_cast<std::size_t>(k)];
          full->polygons.push_back(std::move(line));
        }
      },
      [this, full, leaked, notes, revision](std::exception_ptr failure) {
        ended(Work::Propose, failure);
        if (failure) return;
        if (revision != revision_) {
          emit message(tr("The outlines changed meanwhile; propose again."));
          return;
        }
        noteMade(*full, commands::MadeBy::Proposal);
        replaceContours(std::move(*full), "propose outlines");
        const QString said =
            *leaked ? tr("Proposed, but it reaches the border of the image: it may have leaked. Correct it.")
                    : tr("Proposed on every slice. It counts already: correct and accept it.");
        emit message(said + *notes);
      });
  emit workStarted(tr("Proposing outlines"));
  emit statusChanged();
}

// Those that are there already keep what made them.
void Session::noteMade(const roi::ContourStack& after, commands::MadeBy by) {
  for (const roi::Polygon& p : after.polygons)
    if (p.state == roi::PolygonState::Interpolated) contours_.made.try_emplace(commands::digestOf(p), by);
}

void Session::acceptInterpolated() {
  roi::ContourStack after = contours_;
  std::size_t n = 0;
  for (roi::Polygon& p : after.polygons)
    if (p.state == roi::PolygonState::Interpolated) {
      p.state = roi::PolygonState::Accepted;
      ++n;
    }
  if (n == 0) return;
  replaceContours(std::move(after), "accept all interpolated outlines");
  emit message(tr("Interpolated outlines accepted: %1.").arg(static_cast<qulonglong>(n)));
}

void Session::replaceContours(roi::ContourStack after, const char* text) {
  std::optional<Eigen::Vector3d> here;  // undo stays on the slice that is shown
  if (plane_)
    here = plane_->grid.indexToLps({0.5 * plane_->grid.size.x(), 0.5 * plane_->grid.size.y(), 1.0 * plane_->slice});
  undo_.push(std::make_unique<commands::ReplaceContours>(contours_, std::move(after), text, here), contours_);
  tool_.selectPolygon(std::nullopt);
  tool_.contoursChanged();
  contoursTouched();
}

}  // namespace glisson::session
