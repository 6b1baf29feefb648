// SPDX-License-Identifier: GPL-3.0-or-later

// A mask in other cells: what a cell is covered by is exact, and a body of many cells keeps its volume, wherever the
// cells lie and whichever way its faces look.
#include "image/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "image/components.h"

namespace glisson::image {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3i;

Grid gridOf(const Vector3i& size, const Vector3d& spacing_mm, const Matrix3d& direction = Matrix3d::Identity()) {
  Grid g;
  g.size = size;
  g.spacing_mm = spacing_mm;
  g.direction = direction;
  g.origin_lps_mm = -direction * (0.5 * (size - Vector3i::Ones()).cast<double>().cwiseProduct(spacing_mm));
  return g;
}

Matrix3d oblique() {
  return (Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()) * Eigen::AngleAxisd(0.3, Vector3d::UnitX()))
      .toRotationMatrix();
}

template <class Inside>
Mask drawn(const Grid& g, Inside&& inside) {
  Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) m.at(i, j, k) = inside(g.indexToLps(Vector3d(i, j, k))) ? 1 : 0;
  return m;
}

/// Axes a, b, c along x, y, z (LPS).
auto ellipsoid(const Vector3d& semi_mm, const Vector3d& centre_mm = Vector3d::Zero()) {
  return [=](const Vector3d& p) { return (p - centre_mm).cwiseQuotient(semi_mm).norm() <= 1.0; };
}

double volume_mm3(const Mask& m) {
  double n = 0;
  for (const auto v : m.values) n += v ? 1 : 0;
  return n * m.grid.voxelVolume_mm3();
}

/// Cubes over the whole grid, their lattice moved by `shift` cells.
Grid cubesOver(const Grid& g, double edge_mm, const Vector3d& shift = Vector3d::Zero()) {
  const Vector3d extent_mm = g.size.cast<double>().cwiseProduct(g.spacing_mm);
  Grid cells = gridOf((extent_mm / edge_mm).array().ceil().cast<int>() + 2, Vector3d::Constant(edge_mm), g.direction);
  cells.origin_lps_mm +=
      g.indexToLps(0.5 * (g.size - Vector3i::Ones()).cast<double>()) + g.direction * (edge_mm * shift);
  return cells;
}

/// |volume of the cells / volume of the mask − 1|, in percent.
double off_pct(const Mask& mask, const Grid& cells) {
  return 100.0 * std::abs(volume_mm3(resampleKeepingVolume(mask, cells)) / volume_mm3(mask) - 1.0);
}

TEST(Coverage, SharesAddUpToTheVolume) {
  const Mask m = drawn(gridOf({31, 28, 22}, {2, 2, 3}, oblique()), ellipsoid({25, 20, 27}));
  for (const double edge_mm : {4.0, 3.28, 5.7, 1.3}) {
    const Grid cells = cubesOver(m.grid, edge_mm, Vector3d(0.2, 0.37, -0.4));
    double sum = 0;
    for (const float s : coverage(m, cells).values) {
      EXPECT_GE(s, 0.0F);
      EXPECT_LE(s, 1.0F + 1e-6F);
      sum += static_cast<double>(s);
    }
    EXPECT_NEAR(sum * cells.voxelVolume_mm3() / volume_mm3(m), 1.0, 1e-6) << edge_mm;
  }
}

TEST(Coverage, CellsAcrossTheAxesAreRefused) {
  const Mask m = drawn(gridOf({5, 5, 5}, {1, 1, 1}), ellipsoid({2, 2, 2}));
  EXPECT_THROW(coverage(m, gridOf({5, 5, 5}, {1, 1, 1}, oblique())), BadArgument);
}

TEST(KeepingVolume, ItsOwnVoxelsAndTheirHalvesGiveTheMaskItself) {
  const Mask m = drawn(gridOf({21, 24, 17}, {2, 1.5, 3}, oblique()), ellipsoid({17, 14, 20}));
  EXPECT_EQ(resampleKeepingVolume(m, m.grid).values, m.values);
  const Mask halves = resampleKeepingVolume(m, gridOf(2 * m.grid.size, 0.5 * m.grid.spacing_mm, m.grid.direction));
  for (int k = 0; k < halves.grid.size.z(); ++k)
    for (int j = 0; j < halves.grid.size.y(); ++j)
      for (int i = 0; i < halves.grid.size.x(); ++i)
        ASSERT_EQ(halves.at(i, j, k), m.at(i / 2, j / 2, k / 2)) << i << ' ' << j << ' ' << k;
}

// Cells of about twice the voxel are half covered all over a surface, and were all filled once: 3 to 9 % too much.
TEST(KeepingVolume, OfBallsAndFlatBodies) {
  for (const Matrix3d& axes : {Matrix3d(Matrix3d::Identity()), oblique()})
    for (const Vector3d& spacing_mm : {Vector3d(2, 2, 3), Vector3d(2, 2, 2), Vector3d(1.64, 1.64, 2.5)})
      for (const Vector3d& semi_mm :
           {Vector3d(60, 60, 60), Vector3d(40, 40, 40), Vector3d(60, 60, 20), Vector3d(70, 50, 25)})
        for (const double edge_mm : {2.0 * spacing_mm.x(), 4.0, 5.0}) {
          const Grid g = gridOf(
              (2.0 * (Vector3d::Constant(semi_mm.maxCoeff()).cwiseQuotient(spacing_mm))).array().ceil().cast<int>() + 5,
              spacing_mm, axes);
          const Mask m = drawn(g, ellipsoid(semi_mm, Vector3d(0.3, -0.4, 0.8)));
          for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(0.5, 0.5, 0.5), Vector3d(0.23, -0.31, 0.4)})
            EXPECT_LT(off_pct(m, cubesOver(g, edge_mm, shift)), 0.5)
                << semi_mm.transpose() << " mm, voxels " << spacing_mm.transpose() << ", cells " << edge_mm << ", "
                << shift.transpose() << (axes.isIdentity() ? "" : ", oblique");
        }
}

// A plate that ends in the middle of cells on both sides is moved by half a cell, not made thicker or thinner.
TEST(KeepingVolume, OfAPlateBetweenCells) {
  const Grid g = gridOf({24, 24, 10}, {1, 1, 1});
  for (const int thick : {2, 6}) {
    const Mask plate = drawn(g, [&](const Vector3d& p) { return std::abs(p.z()) < 0.5 * thick; });
    // Faces at odd millimetres, cells of 2 mm whose edges lie on even ones.
    Grid cells = gridOf({12, 12, 7}, {2, 2, 2});
    cells.origin_lps_mm.z() += 1.0;
    int halves = 0;
    for (const float s : coverage(plate, cells).values) halves += std::abs(s - 0.5F) < 1e-6F ? 1 : 0;
    EXPECT_EQ(halves, 2 * 12 * 12);
    EXPECT_DOUBLE_EQ(volume_mm3(resampleKeepingVolume(plate, cells)), volume_mm3(plate)) << thick;
  }
}

// Thin parts are left alone: a plate of less than half a cell goes, one of more stays whole, a finger stays on its
// ball.
TEST(KeepingVolume, LeavesWhatIsThinnerThanACell) {
  const Grid g = gridOf({40, 40, 20}, {1, 1, 1});
  const Grid cells = gridOf({10, 10, 5}, {4, 4, 4});
  const auto plate = [&](double low, double high) {
    const Mask m =
        resampleKeepingVolume(drawn(g, [&](const Vector3d& p) { return p.z() > low && p.z() < high; }), cells);
    return volume_mm3(m) / cells.voxelVolume_mm3();
  };
  EXPECT_EQ(plate(-2, -1), 0);
  EXPECT_EQ(plate(-2, 1), 100);

  const Grid wide = gridOf({70, 40, 40}, {1, 1, 1});
  for (const double shift : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) {
    const Mask m = drawn(wide, [&](const Vector3d& p) {
      return (p - Vector3d(-15, 0, 0)).norm() < 16 || (p.x() > 0 && std::max(std::abs(p.y()), std::abs(p.z())) < 1.8);
    });
    const Mask out = resampleKeepingVolume(m, cubesOver(wide, 4.0, Vector3d(shift, shift, shift)));
    const Mask largest = largestComponent(out);
    EXPECT_EQ(volume_mm3(largest), volume_mm3(out)) << shift;
  }
}

// A block with a layer on top that fills three quarters of its cells is a little too large in cells, and the root of a
// finger of 10 / 16 of a cell is what could be taken away for it: the finger would be lost with it.
TEST(KeepingVolume, TakesNoCellAwayThatJoinsOthers) {
  const Grid g = gridOf({40, 20, 24}, {1, 1, 1});
  Mask m(g);
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 40; ++i) {
        const bool block = i < 20 && k < 23;
        const int row = j - 8, line = k - 8;
        const bool finger = i >= 20 && i < 36 && row >= 0 && row < 4 && line >= 0 && line < 4 && 4 * row + line < 10;
        m.at(i, j, k) = block || finger ? 1 : 0;
      }
  const Mask out = resampleKeepingVolume(m, gridOf({10, 5, 6}, {4, 4, 4}));
  EXPECT_EQ(volume_mm3(out), 64.0 * (5 * 5 * 6 + 4));
  EXPECT_EQ(volume_mm3(largestComponent(out)), volume_mm3(out));
}

}  // namespace
}  // namespace glisson::image
