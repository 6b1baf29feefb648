#include "anatomy/voxelise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"

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

}  // namespace

image::Mask voxelise(const TriangleMesh& mesh, const image::Grid& grid) {
  if (mesh.triangles.cols() == 0 || !isClosed(mesh))
    throw BadInput("the surface is not closed, so it has no inside: close its holes, and keep one shell of triangles");
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
