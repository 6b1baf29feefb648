// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/live_pair.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "pipeline/models.h"

namespace glisson::session {

namespace {

/// The point, or the nearest place of a filled cell within two cells of it: surfaces are smooth and leave the cells by
/// a part of one. Further off the point stays as it is.
Eigen::Vector3d intoBody(const retraction::Model& model, const Eigen::Vector3d& p_mm) {
  constexpr int reach = 2;
  const image::ScalarVolume& body = model.youngs_kPa;
  const Eigen::Vector3d at = body.grid.lpsToIndex(p_mm);
  const Eigen::Vector3i cell = at.array().round().cast<int>();
  const auto filled = [&](const Eigen::Vector3i& c) { return body.grid.contains(c) && body.at(c) > 0.0F; };
  if (filled(cell)) return p_mm;
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d best = at;
  for (int k = -reach; k <= reach; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const Eigen::Vector3i c = cell + Eigen::Vector3i(i, j, k);
        if (!filled(c)) continue;
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.499);
        const Eigen::Vector3d inside = at.cwiseMax(c.cast<double>() - half).cwiseMin(c.cast<double>() + half);
        const double d = (inside - at).cwiseProduct(body.grid.spacing_mm).squaredNorm();
        if (d < least) {
          least = d;
          best = inside;
        }
      }
  return std::isfinite(least) ? body.grid.indexToLps(best) : p_mm;
}

}  // namespace

LivePair::LivePair(const std::filesystem::path& file, const std::optional<retraction::PlacedBar>& bar,
                   const render::RetractionScene& picture, const std::vector<Eigen::Vector3d>& landmarks_mm,
                   const Progress& progress)
    : significant_mm_(picture.clinicallySignificant_mm) {
  pipeline::Scene scene = pipeline::readScene(file);
  const pipeline::Models models = pipeline::buildModels(scene, false, progress.part(0.0, 0.2));
  if (!models.atlas)
    throw BadInput(
        "the scene compares with no atlas: moving live shows both; use the measured stiffness and run again");
  const retraction::LiveKind kind = retraction::liveKindOf(scene.setup);
  for (auto& load : scene.setup.loads)
    if (auto* r = std::get_if<retraction::Retractor>(&load); r != nullptr && bar) *r = bar->bar;
  std::vector<Eigen::Vector3d> points_mm;
  const auto watch = [&](const anatomy::TriangleMesh& mesh) {
    for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
      points_mm.push_back(intoBody(models.model, mesh.vertices_lps_mm.col(n)));
    return mesh.vertices_lps_mm.cols();
  };
  liver_ = watch(picture.liverSurface);
  vessels_ = watch(picture.vesselSurface);
  for (const Eigen::Vector3d& p : landmarks_mm) points_mm.push_back(intoBody(models.model, p));
  livers_ = retraction::makeLive(models.model, &*models.atlas, scene.setup, points_mm, kind, progress.part(0.2, 1.0));
}

void LivePair::follow(const retraction::LiveTarget& hand, LiveComparison comparison, LiveFrame& frame) {
  const auto start = std::chrono::steady_clock::now();
  // Contact: the force of the frame before, so that both livers go on side by side; at rest it is the same.
  retraction::LiveTarget other = hand;
  if (comparison == LiveComparison::EqualForce && !hand.force_N) {
    if (livers_.kind == retraction::LiveKind::Condensed) last_ = livers_.mre->follow(hand);
    other.force_N = last_.force_N;
  }
  const retraction::LiveAnswers now = retraction::followBoth(livers_, hand, other);
  const bool sameForce = comparison == LiveComparison::EqualTravel ||
                         (now.mre.force_N - last_.force_N).norm() <= 1e-3 * now.mre.force_N.norm();
  last_ = now.mre;
  livers_.mre->displacements(frame.mre_mm);
  livers_.atlas->displacements(frame.atlas_mm);
  frame.force_N = now.mre.force_N;
  frame.forceAtlas_N = now.atlas.force_N;
  frame.toolMre_mm = now.mre.tool_mm;
  frame.toolAtlas_mm = now.atlas.tool_mm;
  frame.atTool_mm = (frame.toolMre_mm - frame.toolAtlas_mm).norm();
  frame.remaining_mm = std::max(now.mre.remaining_mm, now.atlas.remaining_mm);
  frame.atRest = now.mre.atRest && now.atlas.atRest && sameForce;
  frame.mre = now.mre.outcome;
  frame.atlas = now.atlas.outcome;
  compare(frame);
  frame.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void LivePair::compare(LiveFrame& frame) const {
  frame.vesselMean_mm = frame.vesselMax_mm = 0.0;
  frame.vesselsBeyond = 0;
  const Eigen::Index first = liver_ + vessels_, landmarks = frame.mre_mm.cols() - first;
  for (Eigen::Index n = first; n < frame.mre_mm.cols(); ++n) {
    const double apart = (frame.mre_mm.col(n) - frame.atlas_mm.col(n)).norm();
    frame.vesselMean_mm += apart / static_cast<double>(landmarks);
    frame.vesselMax_mm = std::max(frame.vesselMax_mm, apart);
    if (apart >= significant_mm_) ++frame.vesselsBeyond;
  }
}

}  // namespace glisson::session
