#include "roi/plane.h"

#include <Eigen/Eigenvalues>
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
  return !plane.wide || std::abs(plane.axes.col(2).dot(grid.direction.col(2))) >= cosOneDegree;
}

double sliceOf(const Polygon& polygon, const image::Grid& grid) {
  const Plane plane = planeOf(polygon);
  const Eigen::Vector3d normal = grid.direction.col(2);
  if (plane.wide) {
    const double cosine = std::abs(plane.axes.col(2).dot(normal));
    if (cosine < cosOneDegree) {
      std::ostringstream why;
      why << "a polygon is tilted by " << std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi
          << " degrees against the slices of the image (at most 1 is allowed); it was drawn on another orientation, so "
             "rasterise it on the image it was drawn on and transfer the mask";
      throw BadInput(why.str());
    }
  }
  const Eigen::VectorXd height_mm = (polygon.points_lps_mm.colwise() - plane.centre_lps_mm).transpose() * normal;
  if (height_mm.cwiseAbs().maxCoeff() > 0.5 * grid.spacing_mm.z()) {
    std::ostringstream why;
    why << "the vertices of a polygon lie up to " << height_mm.cwiseAbs().maxCoeff()
        << " mm off their common plane, more than half a slice (" << 0.5 * grid.spacing_mm.z()
        << " mm); a contour must lie in one slice";
    throw BadInput(why.str());
  }
  return grid.lpsToIndex(plane.centre_lps_mm).z();
}

}  // namespace glisson::roi
