// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/forecast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "mechanics/sites.h"
#include "pipeline/region_file.h"

namespace glisson::pipeline::detail {
namespace {

/// Of the smooth body: staircases are 3/2 as large as a surface that faces all directions alike.
double smoothSurface_mm2(const image::Mask& mask) {
  const image::Grid& g = mask.grid;
  double stairs_mm2 = 0.0;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        if (mask.at(i, j, k) == 0) continue;
        for (int a = 0; a < 3; ++a)
          for (const int side : {-1, 1}) {
            Eigen::Vector3i beside(i, j, k);
            beside[a] += side;
            if (!g.contains(beside) || mask.at(beside) == 0) stairs_mm2 += g.voxelVolume_mm3() / g.spacing_mm[a];
          }
      }
  return stairs_mm2 / 1.5;
}

/// Exactly for a box, from the mask for a mask, for an ordinary liver of 1.5 L otherwise.
BodySize predictBody(const Scene& s) {
  const GeometrySpec& g = s.geometry;
  if (g.kind == GeometrySpec::Kind::Box)
    return {g.size_mm.cwiseQuotient(g.cell_mm).array().round().prod(), g.size_mm.prod(),
            2.0 * g.size_mm.prod() * g.size_mm.cwiseInverse().sum()};
  if (g.kind == GeometrySpec::Kind::Mask) {
    std::vector<std::string> ignored;
    const image::Mask mask = readRegion(g.file, g.label, surfaceCell_mm(g), ignored);
    double filled = 0;
    for (const std::uint8_t v : mask.values) filled += v;
    const double volume_mm3 = filled * mask.grid.voxelVolume_mm3();
    return {g.cell_mm.x() > 0 ? volume_mm3 / g.cell_mm.prod() : filled, volume_mm3, smoothSurface_mm2(mask)};
  }
  constexpr double ordinaryLiver_mm3 = 1.5e6, ordinaryLiver_mm2 = 8e4;
  const double cell_mm3 = g.cell_mm.x() > 0 ? g.cell_mm.prod() : std::pow(2.0 * defaults::mriVoxel.mm(), 3);
  return {ordinaryLiver_mm3 / cell_mm3, ordinaryLiver_mm3, ordinaryLiver_mm2};
}

/// Number of nodes, exactly for a box.
double predictNodes(const Scene& s, double cells) {
  if (s.geometry.kind == GeometrySpec::Kind::Box) {
    const Eigen::Array3d n = s.geometry.size_mm.cwiseQuotient(s.geometry.cell_mm).array().round().max(1.0);
    return (n + 1.0).prod();
  }
  return 1.1 * cells;
}

FramesForecast predictFrames(const mechanics::MeshfreeOptions& o, double nodes, double cells) {
  const int least = mechanics::leastNodesOf(o.kernel, o.order);
  FramesForecast f;
  f.count = std::min(o.frames, mechanics::mostSites(nodes, cells, least));
  f.dofs = 3.0 * mechanics::functionsOf(o.kernel, o.order) * f.count;
  std::ostringstream t;
  if (f.count < o.frames)
    t << "at most " << f.count << " of the " << o.frames << " frames asked for";
  else
    t << f.count << " frames";
  t << (o.kernel == mechanics::Kernel::Mls       ? ", moving least squares"
        : o.kernel == mechanics::Kernel::Voronoi ? ", Voronoi kernel"
                                                 : ", Wendland kernel")
    << (o.order == 1 ? ", order 1" : ", order 2") << ": each needs at least " << least << " of about "
    << static_cast<long long>(nodes) << " voxel nodes";
  f.why = t.str();
  return f;
}

struct DelaunaySize {
  double cells = 0.0;
  double dofs = 0.0;
};

/// Delaunay tetrahedra, to 25 % from 8 to 20 mm. Inside, their number goes with volume / size³; along the surface, with
/// area / size². Both factors of both are fitted to livers, a ball and a flat ellipsoid.
DelaunaySize predictDelaunay(const Scene& s, const BodySize& body) {
  const retraction::ModelSpec& m = s.setup.model;
  double inside = body.volume_mm3 / std::pow(m.cell_mm, 3), along = body.surface_mm2 / std::pow(m.cell_mm, 2);
  for (const retraction::LoadSpec& load : s.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load)) {
      // The bar lies on the surface: half of what is within a distance of its axis is inside the body. The size grows
      // from the bar's reach on (anatomy/tetrahedra.h).
      constexpr double growth = 0.3, step_mm = 0.5;
      for (double r = 0.5 * step_mm;; r += step_mm) {
        const double size_mm = std::min(m.cell_mm, m.toolCell_mm) + growth * std::max(0.0, r - bar->diameter_mm);
        if (size_mm >= m.cell_mm) break;
        const double area_mm2 = 2.0 * (bar->length_mm + std::numbers::pi * r) * step_mm;
        inside += 0.5 * std::numbers::pi * (2.0 * r * bar->length_mm + 4.0 * r * r) * step_mm *
                  (std::pow(size_mm, -3) - std::pow(m.cell_mm, -3));
        along += area_mm2 * (std::pow(size_mm, -2) - std::pow(m.cell_mm, -2));
      }
    }
  DelaunaySize d;
  d.cells = 10.1 * inside + 6.1 * along;
  d.dofs = 3.0 * (m.quadraticTets ? 10.2 * inside + 18.0 * along : 1.16 * inside + 3.1 * along);
  return d;
}

}  // namespace

Forecast::Forecast(const Scene& s) : scene(s), needs(s), body(predictBody(s)) {
  tetrahedra = s.setup.model.kind == retraction::ModelKind::FemTet;
  assembled =
      tetrahedra || (needs.newton && !needs.rigidBar) || s.setup.solver.kind == mechanics::SolverKind::Factorised;
  const bool delaunay = tetrahedra && s.setup.model.delaunay;
  const DelaunaySize mesh = delaunay ? predictDelaunay(s, body) : DelaunaySize{};
  cells = delaunay ? mesh.cells : body.voxels;
  const double nodes = predictNodes(s, body.voxels);
  frames = predictFrames(s.setup.model.meshfree, nodes, body.voxels);
  // A T10 mesh has a node in the middle of each of the seven edges that a voxel adds.
  dofs = needs.meshfree                              ? frames.dofs
         : delaunay                                  ? mesh.dofs
         : tetrahedra && s.setup.model.quadraticTets ? 24.0 * nodes
                                                     : 3.0 * nodes;
  // Bytes and seconds per degree of freedom of one multigrid solve.
  solve_MB = 250e-6 * 3.3 * body.voxels;
  solve_s = 4e-6 * 3.3 * body.voxels;
  answers = needs.compare ? 2.0 : 1.0;
}

}  // namespace glisson::pipeline::detail
