// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/tetrahedra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "anatomy/detail/delaunay.h"
#include "anatomy/detail/organ_domain.h"
#include "anatomy/surface_field.h"
#include "base/error.h"
#include "image/components.h"
#include "image/morphology.h"

namespace glisson::anatomy {
namespace {

constexpr double radiusPerEdge = 0.7;  // circumradius of a cell by its edge; 0.61 in a regular one
constexpr double growth = 0.3;         // of the cell size with the distance from the tool
constexpr double mostCells = 5e6;

void check(const TetrahedraOptions& o) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0.0) || !std::isfinite(value))
      throw BadInput(std::string(name) + " of the tetrahedra is " + std::to_string(value) +
                     "; it must be a positive number");
  };
  positive(o.cell_mm, "the cell size (cell_mm)");
  if (!o.tool) return;
  positive(o.toolCell_mm, "the cell size near the tool (tool_cell_mm)");
  if (o.toolCell_mm > o.cell_mm) throw BadInput("cells near the tool are asked to be larger than the others");
  for (const Eigen::Vector3d& p : *o.tool)
    if (!p.allFinite()) throw BadInput("the tool's place is not finite");
}

double distanceToSegment(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 2>& s) {
  const Eigen::Vector3d d = s[1] - s[0];
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - s[0]).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - s[0] - t * d).norm();
}

double edgeAt(const Eigen::Vector3d& p, const TetrahedraOptions& o) {
  if (!o.tool) return o.cell_mm;
  const double beyond = std::max(0.0, distanceToSegment(p, *o.tool) - o.toolReach_mm);
  return std::min(o.cell_mm, o.toolCell_mm + growth * beyond);
}

/// Parts and cavities that a cell cannot hold are dropped and filled.
image::Mask tidied(const image::Mask& mask, double smallest_mm3, TetrahedralMesh& mesh) {
  const double voxel_mm3 = mask.grid.voxelVolume_mm3();
  image::Mask result(mask.grid);
  const image::Components parts = image::components(mask);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const std::int32_t part = parts.labels.values[i];
    if (part == 0) continue;
    const bool keep =
        part == 1 || static_cast<double>(parts.voxels[static_cast<std::size_t>(part - 1)]) * voxel_mm3 >= smallest_mm3;
    result.values[i] = keep ? 1 : 0;
    if (!keep) mesh.dropped_mL += 1e-3 * voxel_mm3;
  }
  image::Mask cavities = image::fillHoles(result);
  for (std::size_t i = 0; i < cavities.values.size(); ++i) cavities.values[i] -= result.values[i];
  const image::Components holes = image::components(cavities);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const std::int32_t hole = holes.labels.values[i];
    if (hole == 0 || static_cast<double>(holes.voxels[static_cast<std::size_t>(hole - 1)]) * voxel_mm3 >= smallest_mm3)
      continue;
    result.values[i] = 1;
    mesh.filled_mL += 1e-3 * voxel_mm3;
  }
  return result;
}

/// Cells to be expected: by the size wanted where the voxels are. 8.5 cells fill the cube of an edge in a regular mesh.
double expectedCells(const image::Mask& mask, const TetrahedraOptions& o) {
  double sum = 0.0;
  std::size_t at = 0;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i, ++at)
        if (mask.values[at] != 0) {
          const double edge = edgeAt(mask.grid.indexToLps(Eigen::Vector3d(i, j, k)), o);
          sum += 8.5 * mask.grid.voxelVolume_mm3() / (edge * edge * edge);
        }
  return sum;
}

void gate(const TetrahedralMesh& mesh, double wanted_mm3, const TetrahedraOptions& o) {
  const MeshQuality& q = mesh.quality;
  std::ostringstream text;
  text.precision(3);
  if (q.flatOrInverted > 0)
    text << q.flatOrInverted << " flat or inverted cells";
  else if (q.leastDihedral_deg < o.leastDihedral_deg)
    text << "a dihedral angle of " << q.leastDihedral_deg << " degrees (at least " << o.leastDihedral_deg << ")";
  else if (q.worstRadiusEdge > o.largestRadiusEdge)
    text << "a circumradius of " << q.worstRadiusEdge << " shortest edges (at most " << o.largestRadiusEdge << ")";
  else if (std::abs(q.volume_mm3 / wanted_mm3 - 1.0) > o.volumeTolerance)
    text << 1e-3 * q.volume_mm3 << " mL instead of the voxels' " << 1e-3 * wanted_mm3 << " mL (within "
         << 100.0 * o.volumeTolerance << " %)";
  else if (!isClosed(mesh.boundary))
    text << "a boundary that is not closed, or pinched at an edge";
  else
    return;
  throw BadInput("the tetrahedra of the organ have " + text.str() + " at a cell size of " + std::to_string(o.cell_mm) +
                 " mm: the body is too thin or too ragged for it; choose smaller cells, or smooth the outline");
}

}  // namespace

TetrahedralMesh tetrahedra(const image::Mask& mask, const TetrahedraOptions& options, const Progress& progress) {
  check(options);
  const std::size_t voxels = image::count(mask);
  if (voxels == 0) throw BadInput("the mask is empty (no voxel inside): there is nothing to fill with tetrahedra");
  TetrahedralMesh mesh;
  mesh.voxelVolume_mm3 = static_cast<double>(voxels) * mask.grid.voxelVolume_mm3();
  progress.report(0.0, "tetrahedra");
  const image::Mask body = tidied(mask, options.cell_mm * options.cell_mm * options.cell_mm, mesh);
  const double expected = expectedCells(body, options);
  if (expected > mostCells)
    throw BadInput("about " + std::to_string(static_cast<long>(expected)) +
                   " tetrahedra would be needed; at most 5000000 are made: choose larger cells");
  const SurfaceField field = surfaceField(body, 0.0);
  const OrganDomain domain(field);

  DelaunayCriteria criteria;
  criteria.size_mm = [&](const Eigen::Vector3d& p) { return radiusPerEdge * edgeAt(p, options); };
  criteria.distance_mm = options.surfaceError_mm > 0.0 ? options.surfaceError_mm : options.cell_mm / 20.0;
  const std::vector<Eigen::Vector3d> start = domain.pointsOnSurface(options.cell_mm);
  DelaunayCells made;
  if (!start.empty())
    made = delaunayCells([&](const Eigen::Vector3d& p) { return domain.depth_mm(p); }, domain.low(), domain.high(),
                         start, criteria, progress.part(0.1, 0.9));
  if (made.cells.cols() == 0)
    throw BadInput("no tetrahedra of " + std::to_string(options.cell_mm) + " mm fit into the body (" +
                   std::to_string(1e-3 * field.volume_mm3) +
                   " mL): it is too thin for them; choose smaller cells, or check the region of interest");
  mesh.cells = std::move(made.cells);
  mesh.points_lps_mm = std::move(made.points);
  mesh.quality = qualityOf(mesh.points_lps_mm, mesh.cells);
  mesh.boundary = {mesh.points_lps_mm, boundaryOf(mesh.cells)};

  // The moved boundary counts where it is no worse than the gates allow.
  TriangleMesh moved = mesh.boundary;
  moveToVolume(moved, field.volume_mm3);
  const MeshQuality quality = qualityOf(moved.vertices_lps_mm, mesh.cells);
  if (quality.flatOrInverted == 0 && quality.leastDihedral_deg >= options.leastDihedral_deg &&
      quality.worstRadiusEdge <= options.largestRadiusEdge) {
    mesh.points_lps_mm = moved.vertices_lps_mm;
    mesh.boundary = std::move(moved);
    mesh.quality = quality;
  }
  gate(mesh, field.volume_mm3, options);

  std::ostringstream text;
  text.precision(4);
  text << describe(mesh.quality, static_cast<int>(mesh.cells.cols())) << "; volume " << 1e-3 * mesh.quality.volume_mm3
       << " mL";
  if (mesh.dropped_mL > 0.0) text << "; parts smaller than a cell left out: " << mesh.dropped_mL << " mL";
  if (mesh.filled_mL > 0.0) text << "; cavities smaller than a cell filled: " << mesh.filled_mL << " mL";
  mesh.note = text.str();
  progress.report(1.0, "tetrahedra");
  return mesh;
}

}  // namespace glisson::anatomy
