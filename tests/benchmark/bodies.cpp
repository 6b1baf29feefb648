// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <string>

#include "base/parallel.h"
#include "mechanics/loads.h"

namespace glisson::mechanics::bench {
namespace {

using Eigen::Vector3d;

bool inLiver(const Vector3d& p) {
  const auto inside = [&](const Vector3d& centre, const Vector3d& radii) {
    return (p - centre).cwiseQuotient(radii).squaredNorm() < 1;
  };
  return inside({0.080, 0.075, 0.080}, {0.075, 0.070, 0.073}) || inside({0.155, 0.055, 0.095}, {0.070, 0.045, 0.040});
}
const Vector3d extent_m(0.23, 0.15, 0.16);
constexpr double volume_m3 = 1.85e-3;  ///< of both lobes, as measured by their voxels

double modulus_Pa(const Vector3d& p) {
  return 6e3 * std::exp2(std::sin(80 * p.x()) * std::cos(60 * p.y()) + 0.5 * std::sin(70 * p.z()));
}

double memory_MB(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

}  // namespace

Problem liver(int dofs, double poisson, double slice_m) {
  Problem p;
  const double cell_m3 = 3 * volume_m3 / dofs;
  const double h = slice_m > 0 ? std::sqrt(cell_m3 / slice_m) : std::cbrt(cell_m3);
  p.body.h_m = {h, h, slice_m > 0 ? slice_m : h};
  p.body.poisson = poisson;
  for (int c = 0; c < 3; ++c) p.body.cells[c] = static_cast<int>(std::ceil(extent_m[c] / p.body.h_m[c]));
  p.body.E_Pa.assign(static_cast<std::size_t>(p.body.cells.prod()), 0.0);
  for (int k = 0; k < p.body.cells.z(); ++k)
    for (int j = 0; j < p.body.cells.y(); ++j)
      for (int i = 0; i < p.body.cells.x(); ++i) {
        const Vector3d centre = Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(p.body.h_m);
        if (inLiver(centre)) p.body.E_Pa[p.body.cell(i, j, k)] = modulus_Pa(centre);
      }
  const VoxelMesh mesh(p.body);
  std::vector<Face> held;
  for (const Face& face : exteriorFaces(mesh))
    if (face.side == 3 || face.side == 5) held.push_back(face);
  p.supports.springs = faceSprings(mesh, held, 0.2 * N_m3_per_kPa_mm);
  p.f_N = 15.7 * contacts(p, 1).front();
  return p;
}

Problem liverWithTumour(int dofs, double poisson, double contrast) {
  Problem p = liver(dofs, poisson);
  for (int k = 0; k < p.body.cells.z(); ++k)
    for (int j = 0; j < p.body.cells.y(); ++j)
      for (int i = 0; i < p.body.cells.x(); ++i) {
        const Vector3d centre = Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(p.body.h_m);
        if ((centre - Vector3d(0.08, 0.05, 0.07)).norm() < 0.025) p.body.E_Pa[p.body.cell(i, j, k)] *= contrast;
      }
  return p;
}

Problem clampedBox(int cells, double poisson, double contrast) {
  Problem p;
  p.body.cells.setConstant(cells);
  p.body.h_m.setConstant(0.1 / cells);
  p.body.poisson = poisson;
  p.body.E_Pa.assign(static_cast<std::size_t>(p.body.cells.prod()), 6e3);
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        if ((Vector3d(i + 0.5, j + 0.5, k + 0.5) / cells - Vector3d(0.42, 0.55, 0.5)).norm() < 0.25)
          p.body.E_Pa[p.body.cell(i, j, k)] *= contrast;
  const VoxelMesh mesh(p.body);
  std::vector<Face> below, above;
  for (const Face& face : exteriorFaces(mesh)) {
    if (face.side == 4) below.push_back(face);
    if (face.side == 5) above.push_back(face);
  }
  p.supports.fixations = fix(nodesOfFaces(mesh, below));
  p.f_N = tractionForce(mesh, above, Vector3d(100, 50, 30));
  return p;
}

std::vector<NodalField> contacts(const Problem& problem, int count) {
  const VoxelMesh mesh(problem.body);
  std::vector<Face> front;
  for (const Face& face : exteriorFaces(mesh))
    if (face.side == 2) front.push_back(face);
  std::vector<NodalField> all;
  for (int n = 0; n < count; ++n) {
    const Vector3d at(0.05 + 0.12 * n / std::max(1, count), 0, 0.07 + 0.003 * (n % 4));
    Eigen::Matrix3Xd traction = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(front.size()));
    for (std::size_t f = 0; f < front.size(); ++f) {
      const Vector3d d = faceCentre_m(mesh, front[f]) - at;
      const double away = std::hypot(d.x(), d.z()) / 0.015;
      traction.col(static_cast<Eigen::Index>(f)) = std::exp(-0.5 * away * away) * Vector3d(0, 1, 0.2 * (n % 3));
    }
    NodalField f = tractionForce(mesh, front, traction);
    all.push_back(f / f.rowwise().sum().norm());
  }
  return all;
}

void resetPeak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5\n";
}
double peak_MB() {
  return memory_MB("VmHWM:");
}
double resident_MB() {
  return memory_MB("VmRSS:");
}

double triadBytesPerSecond() {
  static std::map<int, double> known;
  const auto found = known.find(threadCount());
  if (found != known.end()) return found->second;
  const std::size_t n = std::size_t{1} << 25;  // 128 MB an array
  std::vector<float> a(n, 0.0F), b(n, 1.0F), c(n, 2.0F);
  double best = 0;
  for (int run = 0; run < 10; ++run) {
    const auto start = std::chrono::steady_clock::now();
    parallelChunks(n, std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 3.0F * c[i];
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::max(best, 3 * sizeof(float) * static_cast<double>(n) / seconds);
  }
  return known[threadCount()] = best;
}

}  // namespace glisson::mechanics::bench
