// SPDX-License-Identifier: GPL-3.0-or-later

// Bar, hoist and holds laid by hand, with an undo of their own: Ctrl+Z takes back what the page shows.
#include "session/model_preview.h"
#include "session/session.h"

namespace glisson::session {

bool Placement::operator==(const Placement& other) const {
  if (barAt_lps.has_value() != other.barAt_lps.has_value()) return false;
  if (barAt_lps && *barAt_lps != *other.barAt_lps) return false;
  return barAxis == other.barAxis && hoistDirection == other.hoistDirection && holds == other.holds;
}

void apply(const Placement& placement, retraction::Setup& setup) {
  for (retraction::LoadSpec& load : setup.loads)
    if (auto* bar = std::get_if<retraction::Retractor>(&load)) {
      bar->at_mm = placement.barAt_lps;
      // Where nothing was laid, geometry says how the bar lies.
      if (placement.barAt_lps || placement.barAxis != Placement{}.barAxis) bar->axis = placement.barAxis;
      bar->direction = placement.hoistDirection;
    }
  for (const Placement::Hold& hold : placement.holds) {
    retraction::SupportSpec& s = setup.supports.emplace_back();
    s.kind = retraction::SupportSpec::Kind::Fixed;
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * hold.edge_mm);
    s.region.emplace<retraction::BoxRegion>(retraction::BoxRegion{hold.centre_lps - half, hold.centre_lps + half});
  }
}

void Session::place(const Placement& placement, double barLength_mm, const QString& what) {
  const Placed before{parameters_.placement, parameters_.retractorLength_mm}, after{placement, barLength_mm};
  if (before == after) return;
  placings_.resize(placingsDone_);
  placings_.push_back({before, after, what});
  placingsDone_ = placings_.size();
  take(after);
}

void Session::undoPlacement() {
  if (canUndoPlacement()) take(placings_[--placingsDone_].before);
}

void Session::redoPlacement() {
  if (canRedoPlacement()) take(placings_[placingsDone_++].after);
}

void Session::take(const Placed& placed) {
  Parameters p = parameters_;
  p.placement = placed.placement;
  p.retractorLength_mm = placed.barLength_mm;
  setParameters(p);
}

void Session::forgetPlacings() {
  placings_.clear();
  placingsDone_ = 0;
}

ModelPreview& Session::preview() {
  if (!preview_) preview_ = new ModelPreview(*this);
  return *preview_;
}

}  // namespace glisson::session
