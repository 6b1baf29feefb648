// SPDX-License-Identifier: GPL-3.0-or-later

// What the pictures show of how sure a run is: probabilities on cells, and what holds the vessels with 95 %.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "anatomy/surface.h"
#include "pipeline/detail/outputs.h"

namespace glisson::pipeline::detail {
namespace {

/// Standard deviations to the surface that holds 95 % of a normal vector in space: root of the quantile of χ² with 3
/// degrees of freedom.
constexpr double sds95 = 2.7955;
constexpr double finest_mm = 1.0, coarsest_mm = 2.5;  ///< cells that the tube's surface is made on

/// What holds a place of a vessel with its wall.
struct Ellipsoid {
  Eigen::Vector3d centre;
  Eigen::Vector3d axes_mm;     ///< half, ascending
  Eigen::Matrix3d directions;  ///< a column per axis

  Eigen::Vector3d reach_mm() const {
    return (directions.array().square().matrix() * axes_mm.array().square().matrix()).array().sqrt();
  }
  bool holds(const Eigen::Vector3d& p) const {
    return (directions.transpose() * (p - centre)).cwiseQuotient(axes_mm).squaredNorm() <= 1.0;
  }
};

/// One per landmark with a spread, thinned out to where the next is a quarter of its smallest half axis away: their
/// union hardly changes, and its cost does not grow with the spread.
std::vector<Ellipsoid> ellipsoidsOf(const RunResult& r, const anatomy::VesselModel& vessels) {
  std::vector<Ellipsoid> kept;
  const auto u = retraction::displacementAt(r.model, r.primary, vessels.centreline_lps_mm);
  for (const uncertainty::LandmarkSpread& s : r.uncertainty->spread.landmarks) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(s.place_mm2);
    Ellipsoid e{vessels.centreline_lps_mm[s.landmark] + u[s.landmark],
                sds95 * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt() +
                    Eigen::Vector3d::Constant(std::max(vessels.radius_mm[s.landmark], finest_mm)),
                eigen.eigenvectors()};
    const bool near = std::any_of(kept.begin(), kept.end(), [&](const Ellipsoid& other) {
      return (other.centre - e.centre).norm() < 0.25 * other.axes_mm.minCoeff();
    });
    if (!near) kept.push_back(std::move(e));
  }
  return kept;
}

anatomy::TriangleMesh unionOf(const std::vector<Ellipsoid>& ellipsoids) {
  if (ellipsoids.empty()) return {};
  Eigen::AlignedBox3d box;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Ellipsoid& e : ellipsoids) {
    box.extend(e.centre - e.reach_mm());
    box.extend(e.centre + e.reach_mm());
    smallest = std::min(smallest, e.axes_mm.minCoeff());
  }
  image::Grid grid;
  grid.spacing_mm.setConstant(std::clamp(smallest / 3.0, finest_mm, coarsest_mm));
  const double step = grid.spacing_mm.x();
  grid.origin_lps_mm = box.min() - Eigen::Vector3d::Constant(2.0 * step);
  grid.size = ((box.sizes() / step).array().ceil() + 5.0).cast<int>();
  image::Mask inside(grid);
  for (const Ellipsoid& e : ellipsoids) {
    const Eigen::Vector3i low = ((e.centre - e.reach_mm() - grid.origin_lps_mm) / step).array().floor().cast<int>(),
                          high = ((e.centre + e.reach_mm() - grid.origin_lps_mm) / step).array().ceil().cast<int>();
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i)
          if (e.holds(grid.origin_lps_mm + step * Eigen::Vector3d(i, j, k))) inside.at(i, j, k) = 1;
  }
  return anatomy::liverSurface(inside);
}

/// Per vertex of the vessels' surface, from the nearest landmark that has a spread.
Eigen::VectorXf places95(const RunResult& r, const anatomy::VesselModel& vessels) {
  std::vector<float> radius;
  for (const uncertainty::LandmarkSpread& s : r.uncertainty->spread.landmarks)
    radius.push_back(static_cast<float>(uncertainty::radius95_mm(s.place_mm2)));
  Eigen::VectorXf out(vessels.surface.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < out.size(); ++n) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < radius.size(); ++l) {
      const std::size_t landmark = r.uncertainty->spread.landmarks[l].landmark;
      const double square =
          (vessels.centreline_lps_mm[landmark] - vessels.surface.vertices_lps_mm.col(n)).squaredNorm();
      if (square >= least) continue;
      least = square;
      out[n] = radius[l];
    }
  }
  return out;
}

}  // namespace

std::optional<render::HowSure> howSureOf(const RunResult& r, const anatomy::VesselModel& vessels) {
  if (!r.uncertainty || !r.uncertainty->known) return {};
  render::HowSure sure;
  if (r.uncertainty->beyond) sure.beyond = *r.uncertainty->beyond;
  if (r.uncertainty->spread.landmarks.empty()) return sure;
  sure.tube = unionOf(ellipsoidsOf(r, vessels));
  sure.vessel95_mm = places95(r, vessels);
  return sure;
}

}  // namespace glisson::pipeline::detail
