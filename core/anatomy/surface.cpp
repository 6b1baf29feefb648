// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "anatomy/detail/delaunay.h"
#include "anatomy/detail/isosurface.h"
#include "anatomy/detail/organ_domain.h"
#include "anatomy/mesh_quality.h"
#include "anatomy/surface_field.h"
#include "base/error.h"

namespace glisson::anatomy {
namespace {

/// The boundary of restricted Delaunay cells, without the points inside.
TriangleMesh refinedSurface(const SurfaceField& field, double edge_mm) {
  const OrganDomain domain(field);
  if (edge_mm <= 0.0) edge_mm = (domain.high() - domain.low()).maxCoeff() / 16.0;
  DelaunayCriteria criteria;
  criteria.cells = false;
  criteria.size_mm = [&](const Eigen::Vector3d&) { return 0.6 * edge_mm; };
  criteria.distance_mm = edge_mm / 10.0;
  const DelaunayCells made = delaunayCells([&](const Eigen::Vector3d& p) { return domain.depth_mm(p); }, domain.low(),
                                           domain.high(), domain.pointsOnSurface(edge_mm), criteria, {});
  TriangleMesh mesh;
  if (made.cells.cols() == 0) return mesh;
  mesh.triangles = boundaryOf(made.cells);
  Eigen::VectorXi number = Eigen::VectorXi::Constant(made.points.cols(), -1);
  int count = 0;
  for (int& v : mesh.triangles.reshaped()) {
    if (number[v] < 0) number[v] = count++;
    v = number[v];
  }
  mesh.vertices_lps_mm.resize(3, count);
  for (Eigen::Index p = 0; p < number.size(); ++p)
    if (number[p] >= 0) mesh.vertices_lps_mm.col(number[p]) = made.points.col(p);
  return mesh;
}

}  // namespace

TriangleMesh liverSurface(const image::Mask& mask, const SurfaceOptions& options) {
  const bool delaunay = options.method == SurfaceMethod::Delaunay;
  const SurfaceField field = surfaceField(mask, delaunay ? 0.0 : options.resolution_mm);
  TriangleMesh mesh = delaunay ? refinedSurface(field, options.resolution_mm)
                               : isosurface(field.values_mm, field.level_mm, options.smoothing);
  if (mesh.triangles.cols() == 0)
    throw BadInput("the mask is thinner than the resolution of the surface (" +
                   std::to_string(field.values_mm.grid.spacing_mm.mean()) + " mm)");
  moveToVolume(mesh, field.volume_mm3);
  return mesh;
}

}  // namespace glisson::anatomy
