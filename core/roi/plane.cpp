// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"

namespace glisson::roi {
namespace {

const double cosOneDegree = std::cos(std::numbers::pi / 180.0);

void checkPoints(const Polygon& polygon) {
  const auto n = polygon.points_lps_mm.cols();
  if (n < 3) throw BadInput("a polygon has " + std::to_string(n) + " vertices; draw at least three");
  if (!polygon.points_lps_mm.allFinite() || polygon.points_lps_mm.cwiseAbs().maxCoeff() > 1e6)
    throw BadInput("a polygon has a vertex that is not finite or beyond 1000 m; check the coordinates of the contours");
}

/// Largest distance of a vertex from the height of the middle, along the normal of the slices.
double offLevel_mm(const Polygon& polygon, const Plane& plane, const image::Grid& grid) {
  return ((polygon.points_lps_mm.colwise() - plane.centre_lps_mm).transpose() * grid.direction.col(2))
      .cwiseAbs()
      .maxCoeff();
}

}  // namespace

Plane planeOf(const Polygon& polygon) {
  checkPoints(polygon);
  Plane plane;
  plane.centre_lps_mm = polygon.points_lps_mm.rowwise().mean();
  const Eigen::Matrix3Xd offset_mm = polygon.points_lps_mm.colwise() - plane.centre_lps_mm;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(offset_mm * offset_mm.transpose());
  plane.wide = solver.eigenvalues()[1] > 1e-8 * solver.eigenvalues()[2] && solver.eigenvalues()[2] > 0.0;
  plane.axes.col(0) = solver.eigenvectors().col(2);
  plane.axes.col(1) = solver.eigenvectors().col(1);
  plane.axes.col(2) = plane.axes.col(0).cross(plane.axes.col(1));
  return plane;
}

bool parallelTo(const Polygon& polygon, const image::Grid& grid) {
  const Plane plane = planeOf(polygon);
  return !plane.wide || std::abs(plane.axes.col(2).dot(grid.direction.col(2))) >= cosOneDegree ||
         offLevel_mm(polygon, plane, grid) <= levelWithin_slices * grid.spacing_mm.z();
}

double sliceOf(const Polygon& polygon, const image::Grid& grid) {
  const Plane plane = planeOf(polygon);
  const double off_mm = offLevel_mm(polygon, plane, grid);
  const double cosine = std::abs(plane.axes.col(2).dot(grid.direction.col(2)));
  if (plane.wide && cosine < cosOneDegree && off_mm > levelWithin_slices * grid.spacing_mm.z()) {
    std::ostringstream why;
    why << "a polygon is tilted by " << std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi
        << " degrees against the slices of the image (at most 1 is allowed); it was drawn on another orientation, so "
           "rasterise it on the image it was drawn on and transfer the mask";
    throw BadInput(why.str());
  }
  if (off_mm > 0.5 * grid.spacing_mm.z()) {
    std::ostringstream why;
    why << "the vertices of a polygon lie up to " << off_mm << " mm off their common plane, more than half a slice ("
        << 0.5 * grid.spacing_mm.z() << " mm); a contour must lie in one slice";
    throw BadInput(why.str());
  }
  return grid.lpsToIndex(plane.centre_lps_mm).z();
}

std::vector<FlatPolygons> flatPlanesOf(const ContourStack& contours) {
  constexpr double samePlane_mm = 0.01, small_mm = 0.1, sameNormal = 0.9998;
  struct Flat {
    std::size_t polygon;
    Plane plane;
    double extent_mm;
  };
  std::vector<Flat> all;
  for (std::size_t p = 0; p < contours.polygons.size(); ++p) {
    const Polygon& polygon = contours.polygons[p];
    if (polygon.state == PolygonState::Draft) continue;
    const Plane plane = planeOf(polygon);
    all.push_back({p, plane, (polygon.points_lps_mm.colwise() - plane.centre_lps_mm).colwise().norm().maxCoeff()});
  }
  // The largest say where the planes are: rounded coordinates tilt small ones.
  std::stable_sort(all.begin(), all.end(), [](const Flat& a, const Flat& b) { return a.extent_mm > b.extent_mm; });
  std::vector<FlatPolygons> planes;
  std::vector<bool> done(all.size(), false);
  for (std::size_t first = 0; first < all.size(); ++first) {
    const Plane& plane = all[first].plane;
    if (done[first] || !plane.wide) continue;
    FlatPolygons flat;
    for (std::size_t n = first; n < all.size(); ++n) {
      if (done[n]) continue;
      const Eigen::Matrix3Xd offset_mm =
          contours.polygons[all[n].polygon].points_lps_mm.colwise() - plane.centre_lps_mm;
      const Plane& other = all[n].plane;
      const bool same = (std::abs((other.centre_lps_mm - plane.centre_lps_mm).dot(plane.axes.col(2))) < samePlane_mm &&
                         (!other.wide || std::abs(other.axes.col(2).dot(plane.axes.col(2))) > sameNormal)) ||
                        (plane.axes.col(2).transpose() * offset_mm).cwiseAbs().maxCoeff() < small_mm;
      if (!same) continue;
      done[n] = true;
      flat.members.push_back(all[n].polygon);
      flat.rings_mm.emplace_back(plane.axes.leftCols<2>().transpose() * offset_mm);
    }
    planes.push_back(std::move(flat));
  }
  return planes;
}

}  // namespace glisson::roi
