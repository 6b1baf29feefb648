#include "session/live_pair.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "pipeline/models.h"

namespace glisson::session {

struct LivePair::Parts {
  retraction::Model mre, atlas;
  retraction::Setup setup;
  std::vector<Eigen::Vector3d> points_mm;
  Eigen::Index liver = 0, vessels = 0;
  double significant_mm = 5.0;
};

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

LivePair::Parts LivePair::partsOf(const std::filesystem::path& file, const render::RetractionScene& picture,
                                  const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress) {
  const pipeline::Scene scene = pipeline::readScene(file);
  pipeline::Models models = pipeline::buildModels(scene, false, progress);
  if (!models.atlas)
    throw BadInput(
        "the scene compares with no atlas: moving live shows both; use the measured stiffness and run again");
  Parts parts{std::move(models.model),         std::move(*models.atlas), scene.setup, {}, 0, 0,
              picture.clinicallySignificant_mm};
  const auto watch = [&parts](const anatomy::TriangleMesh& mesh) {
    for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
      parts.points_mm.push_back(intoBody(parts.mre, mesh.vertices_lps_mm.col(n)));
    return mesh.vertices_lps_mm.cols();
  };
  parts.liver = watch(picture.liverSurface);
  parts.vessels = watch(picture.vesselSurface);
  for (const Eigen::Vector3d& p : landmarks_mm) parts.points_mm.push_back(intoBody(parts.mre, p));
  return parts;
}

LivePair::LivePair(const std::filesystem::path& scene, const render::RetractionScene& picture,
                   const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress)
    : LivePair(partsOf(scene, picture, landmarks_mm, progress.part(0.0, 0.2)), progress.part(0.2, 1.0)) {}

LivePair::LivePair(const Parts& parts, const Progress& progress)
    : liver_(parts.liver),
      vessels_(parts.vessels),
      significant_mm_(parts.significant_mm),
      mre_(parts.mre, parts.setup, parts.points_mm, false, progress.part(0.0, 0.5)),
      atlas_(parts.atlas, parts.setup, parts.points_mm, false, progress.part(0.5, 1.0)) {}

void LivePair::followTool(const Eigen::Vector3d& displacement_mm, LiveFrame& frame) const {
  followForce(mre_.forceFor(displacement_mm), frame);
}

void LivePair::followForce(const Eigen::Vector3d& force_N, LiveFrame& frame) const {
  mre_.evaluate(force_N, frame.mre_mm);
  atlas_.evaluate(force_N, frame.atlas_mm);
  frame.force_N = force_N;
  frame.toolMre_mm = mre_.toolDisplacement_mm(force_N);
  frame.toolAtlas_mm = atlas_.toolDisplacement_mm(force_N);
  frame.atTool_mm = (frame.toolMre_mm - frame.toolAtlas_mm).norm();
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
