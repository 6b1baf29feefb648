// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/voxelise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"
#include "roi/arrangement.h"

namespace glisson::anatomy {
namespace {

/// Irrational multiples, so that symmetric shapes on round coordinates are not hit at an edge either.
constexpr double shiftY = 0.6180339887e-7, shiftZ = 0.4142135624e-7;

/// Which side of the directed line a → b the point (y, z) lies on. Computed from the lower vertex to the higher one, so
/// that the two triangles of an edge always agree.
bool leftOf(const Eigen::Matrix3Xd& v, int a, int b, double y, double z) {
  const bool swapped = a > b;
  if (swapped) std::swap(a, b);
  const double side = (v(1, b) - v(1, a)) * (z - v(2, a)) - (v(2, b) - v(2, a)) * (y - v(1, a));
  return (side >= 0) != swapped;
}

/// Even-odd over all triangles; the same centres whatever part of a lattice grid is.
image::Mask filled(const TriangleMesh& mesh, const image::Grid& grid) {
  Eigen::Matrix3Xd v(3, mesh.vertices_lps_mm.cols());  // in voxels
  for (Eigen::Index i = 0; i < v.cols(); ++i) v.col(i) = grid.lpsToIndex(mesh.vertices_lps_mm.col(i));

  // Triangles by the planes that they cross, in order.
  const auto planes = static_cast<std::size_t>(grid.size.z());
  std::vector<std::vector<int>> crossing(planes);
  for (int t = 0; t < mesh.triangles.cols(); ++t) {
    const auto z = v(2, mesh.triangles.col(t)).eval();
    const double low = std::max(0.0, std::floor(z.minCoeff())),
                 high = std::min<double>(grid.size.z() - 1, std::ceil(z.maxCoeff()));
    for (double k = low; k <= high; k += 1.0) crossing[static_cast<std::size_t>(k)].push_back(t);
  }

  image::Mask mask(grid);
  parallelChunks(planes, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double z = static_cast<double>(k) + shiftZ;
      std::vector<std::vector<double>> hits(static_cast<std::size_t>(grid.size.y()));
      for (const int t : crossing[k]) {
        const Eigen::Vector3i c = mesh.triangles.col(t);
        const auto ys = v(1, c).eval();
        const double low = std::max(0.0, std::floor(ys.minCoeff())),
                     high = std::min<double>(grid.size.y() - 1, std::ceil(ys.maxCoeff()));
        for (double j = low; j <= high; j += 1.0) {
          const double y = j + shiftY;
          const bool a = leftOf(v, c[0], c[1], y, z), b = leftOf(v, c[1], c[2], y, z), d = leftOf(v, c[2], c[0], y, z);
          if (a != b || b != d) continue;
          const Eigen::Vector3d p = v.col(c[0]), u = v.col(c[1]) - p, w = v.col(c[2]) - p, n = u.cross(w);
          if (n.x() == 0) continue;
          hits[static_cast<std::size_t>(j)].push_back(p.x() - (n.y() * (y - p.y()) + n.z() * (z - p.z())) / n.x());
        }
      }
      for (int j = 0; j < grid.size.y(); ++j) {
        std::vector<double>& x = hits[static_cast<std::size_t>(j)];
        std::sort(x.begin(), x.end());
        for (std::size_t h = 0; h + 1 < x.size(); h += 2) {
          const int from = static_cast<int>(std::clamp(std::ceil(x[h]), 0.0, static_cast<double>(grid.size.x()))),
                    to = static_cast<int>(std::clamp(std::ceil(x[h + 1]), 0.0, static_cast<double>(grid.size.x())));
          for (int i = from; i < to; ++i) mask.at(i, j, static_cast<int>(k)) = 1;
        }
      }
    }
  });
  return mask;
}

/// A shell and the box of voxels around it.
struct Shell {
  TriangleMesh mesh;
  Eigen::Vector3i first = Eigen::Vector3i::Zero();
  image::Mask inside;
  double volume_mm3 = 0.0, area_mm2 = 0.0;
  std::size_t voxels = 0;
};

Shell shellOf(TriangleMesh mesh, const image::Grid& grid) {
  Shell s;
  s.volume_mm3 = volume_mm3(mesh);
  s.area_mm2 = area_mm2(mesh);
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (Eigen::Index i = 0; i < mesh.vertices_lps_mm.cols(); ++i) {
    const Eigen::Vector3d index = grid.lpsToIndex(mesh.vertices_lps_mm.col(i));
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  const Eigen::Vector3d last = (grid.size - Eigen::Vector3i::Ones()).cast<double>();
  const Eigen::Vector3d from = low.array().floor().max(0.0).min(last.array()),
                        to = high.array().ceil().max(0.0).min(last.array());
  image::Grid box = grid;
  s.first = from.cast<int>();
  box.size = (to - from).cast<int>() + Eigen::Vector3i::Ones();
  box.origin_lps_mm = grid.indexToLps(from);
  s.inside = filled(mesh, box);
  s.voxels = image::count(s.inside);
  s.mesh = std::move(mesh);
  return s;
}

std::size_t shared(const Shell& a, const Shell& b) {
  const Eigen::Vector3i low = a.first.cwiseMax(b.first),
                        high = (a.first + a.inside.grid.size).cwiseMin(b.first + b.inside.grid.size);
  std::size_t n = 0;
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i) {
        const Eigen::Vector3i at(i, j, k);
        n += a.inside.at(at - a.first) != 0 && b.inside.at(at - b.first) != 0 ? 1U : 0U;
      }
  return n;
}

/// How b lies to a, which holds as many voxels at least.
roi::Relation relationOf(const Shell& a, const Shell& b, double voxel_mm3) {
  constexpr double few = 0.01, mostlyAlike = 0.5;
  const auto both = static_cast<double>(shared(a, b)), inA = static_cast<double>(a.voxels),
             inB = static_cast<double>(b.voxels);
  if (inB == 0.0) return roi::Relation::Apart;
  const double differing_mm3 = voxel_mm3 * (inA + inB - 2.0 * both);
  if (both > mostlyAlike * (inA + inB - both) &&
      differing_mm3 < roi::repeatedWithin_mm * 0.5 * (a.area_mm2 + b.area_mm2))
    return roi::Relation::Repeated;
  if (both <= few * inB) return roi::Relation::Apart;
  return inB - both <= few * inB ? roi::Relation::Enclosed : roi::Relation::Crossing;
}

/// The shells of a closed surface: triangles that hang together by edges.
std::vector<TriangleMesh> shellsOf(const TriangleMesh& mesh) {
  DisjointSets sets(static_cast<int>(mesh.triangles.cols()));
  std::vector<std::array<int, 3>> edges;  // two ends, ascending, and the triangle
  for (int t = 0; t < mesh.triangles.cols(); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.triangles(c, t), b = mesh.triangles((c + 1) % 3, t);
      edges.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1]) sets.join(edges[e][2], edges[e - 1][2]);
  std::map<int, std::vector<int>> members;
  for (int t = 0; t < mesh.triangles.cols(); ++t) members[sets.find(t)].push_back(t);
  if (members.size() == 1) return {mesh};
  std::vector<TriangleMesh> shells;
  std::vector<int> to(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()));
  for (const auto& [root, triangles] : members) {
    std::fill(to.begin(), to.end(), -1);
    TriangleMesh shell;
    shell.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    std::vector<int> kept;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) {
        int& at = to[static_cast<std::size_t>(mesh.triangles(c, triangles[t]))];
        if (at < 0) {
          at = static_cast<int>(kept.size());
          kept.push_back(mesh.triangles(c, triangles[t]));
        }
        shell.triangles(c, static_cast<Eigen::Index>(t)) = at;
      }
    shell.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t v = 0; v < kept.size(); ++v)
      shell.vertices_lps_mm.col(static_cast<Eigen::Index>(v)) = mesh.vertices_lps_mm.col(kept[v]);
    shells.push_back(std::move(shell));
  }
  return shells;
}

void tell(const std::vector<Shell>& shells, const roi::Arrangement& arrangement, Diagnostics& doubts) {
  std::int64_t turned = 0, specks = 0;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    turned += arrangement.level[s] > 0 && arrangement.level[s] % 2 == 1 && shells[s].volume_mm3 > 0 ? 1 : 0;
    specks += shells[s].voxels == 0 ? 1 : 0;
  }
  const auto add = [&](DiagnosticCode code, std::int64_t count) {
    if (count > 0) doubts.add(code, {{"count", count}, {"shells", static_cast<std::int64_t>(shells.size())}});
  };
  add(DiagnosticCode::ShellsRepeated, static_cast<std::int64_t>(arrangement.repeated));
  add(DiagnosticCode::ShellsCross, static_cast<std::int64_t>(arrangement.overlapping));
  add(DiagnosticCode::ShellsTurned, turned);
  add(DiagnosticCode::ShellSpecks, specks);
}

}  // namespace

image::Mask voxelise(const TriangleMesh& mesh, const image::Grid& grid, Diagnostics* doubts) {
  if (mesh.triangles.cols() == 0 || !isClosed(mesh))
    throw BadInput("the surface is not closed, so it has no inside: close its holes, and keep one shell of triangles");
  std::vector<TriangleMesh> meshes = shellsOf(mesh);
  if (meshes.size() == 1) return filled(mesh, grid);
  std::vector<Shell> shells;
  for (TriangleMesh& m : meshes) shells.push_back(shellOf(std::move(m), grid));
  std::vector<std::size_t> order(shells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shells[a].voxels > shells[b].voxels; });
  const roi::Arrangement arrangement = roi::arrangeSets(
      order, [&](std::size_t a, std::size_t b) { return relationOf(shells[a], shells[b], grid.voxelVolume_mm3()); });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return arrangement.level[a] < arrangement.level[b]; });
  image::Mask mask(grid);
  for (const std::size_t s : order) {
    if (arrangement.level[s] < 0) continue;
    const image::Mask& part = shells[s].inside;
    const std::uint8_t value = arrangement.level[s] % 2 == 0 ? 1 : 0;
    for (int k = 0; k < part.grid.size.z(); ++k)
      for (int j = 0; j < part.grid.size.y(); ++j)
        for (int i = 0; i < part.grid.size.x(); ++i)
          if (part.at(i, j, k) != 0) mask.at(shells[s].first + Eigen::Vector3i(i, j, k)) = value;
  }
  if (doubts != nullptr) tell(shells, arrangement, *doubts);
  return mask;
}

image::Grid gridAround(const TriangleMesh& mesh, std::optional<Eigen::Vector3d> spacing_mm) {
  if (mesh.vertices_lps_mm.cols() == 0) throw BadInput("the surface has no points");
  const Eigen::Vector3d low = mesh.vertices_lps_mm.rowwise().minCoeff(),
                        size = mesh.vertices_lps_mm.rowwise().maxCoeff() - low;
  if (!(size.minCoeff() > 0) || !size.allFinite()) throw BadInput("the surface has no extent");
  image::Grid g;
  g.spacing_mm = spacing_mm.value_or(Eigen::Vector3d::Constant(std::max(0.2, size.maxCoeff() / 256.0)));
  const Eigen::Array3d voxels = (size.cwiseQuotient(g.spacing_mm)).array().ceil() + 4.0;
  if (!(voxels.prod() <= 2e8))
    throw BadInput("the surface is " + std::to_string(size.maxCoeff()) +
                   " mm long, too long for its voxels: are its coordinates millimetres?");
  g.size = voxels.cast<int>();
  g.origin_lps_mm = low - 1.5 * g.spacing_mm;
  return g;
}

}  // namespace glisson::anatomy
