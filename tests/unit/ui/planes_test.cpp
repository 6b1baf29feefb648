// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "image/reorient.h"
#include "tools/patient_planes.h"
#include "tools/region_cut.h"

namespace glisson::tools {
namespace {

using Eigen::Vector3d;

/// Slices of this plane, turned by some degrees out of it; LPS.
image::Grid gridIn(PatientPlane plane, double degrees) {
  image::Grid grid;
  grid.size = {9, 8, 7};
  grid.spacing_mm = {1.0, 1.5, 4.0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (plane == PatientPlane::Coronal) axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (plane == PatientPlane::Sagittal) axes << 0, 0, 1, 1, 0, 0, 0, -1, 0;
  grid.direction =
      Eigen::AngleAxisd(degrees * M_PI / 180.0, Vector3d(0.4, 0.5, 0.3).normalized()).toRotationMatrix() * axes;
  return grid;
}

TEST(PatientPlanes, AreThoseThatTheSlicesAreNearestTo) {
  for (const PatientPlane plane : {PatientPlane::Axial, PatientPlane::Coronal, PatientPlane::Sagittal})
    for (const double degrees : {0.0, 12.0, -25.0}) {
      const image::Grid grid = gridIn(plane, degrees);
      EXPECT_EQ(planeOf(grid), plane) << degrees;
      for (const PatientPlane across : planesAcross(grid)) {
        EXPECT_NE(across, plane);
        EXPECT_EQ(planeOf(image::permuted(grid, axesOf(across, grid))), across);
      }
      EXPECT_EQ(planeOf(image::permuted(grid, axesOf(plane, grid))), plane);
    }
}

TEST(PatientPlanes, RowsOfAReformatRunAcrossThePatientAndColumnsDown) {
  const image::Grid grid = gridIn(PatientPlane::Axial, 10.0);
  const auto along = [&](PatientPlane plane, int column) {
    Eigen::Index axis = 0;
    image::permuted(grid, axesOf(plane, grid)).direction.col(column).cwiseAbs().maxCoeff(&axis);
    return axis;
  };
  EXPECT_EQ(along(PatientPlane::Coronal, 0), 0);
  EXPECT_EQ(along(PatientPlane::Coronal, 1), 2);
  EXPECT_EQ(along(PatientPlane::Sagittal, 0), 1);
  EXPECT_EQ(along(PatientPlane::Sagittal, 1), 2);
}

double lengthOf(const std::vector<BorderEdge>& edges, const image::Grid& grid) {
  double sum = 0.0;
  for (const BorderEdge& e : edges) sum += (e.to - e.from).cwiseProduct(grid.spacing_mm.head<2>()).norm();
  return sum;
}

TEST(RegionCut, IsTheBorderOfWhatCountsStepsIncluded) {
  const image::Grid grid = gridIn(PatientPlane::Axial, 0.0);
  // A staircase: on slice k columns up to k + 1.
  image::Mask region(grid);
  for (int k = 1; k <= 4; ++k)
    for (int j = 2; j <= 5; ++j)
      for (int i = 1; i <= k + 1; ++i) region.at(i, j, k) = 1;
  const image::Grid coronal = image::permuted(grid, axesOf(PatientPlane::Coronal, grid));
  const auto edges = cutOf(region, coronal, 3);
  // Width at its widest, there and back (5 mm each), height there and back (4 slices of 4 mm each).
  EXPECT_NEAR(lengthOf(edges, coronal), 2.0 * 5.0 + 2.0 * 16.0, 1e-9);
  // A flat left side is one edge; every step on the right has one.
  std::size_t upright = 0;
  for (const BorderEdge& e : edges) upright += e.from.x() == e.to.x();
  EXPECT_EQ(upright, 1u + 4u);
  EXPECT_TRUE(cutOf(region, coronal, 0).empty());
  EXPECT_TRUE(cutOf(region, coronal, 7).empty());
}

TEST(RegionCut, OfARegionOnAnotherGridTakesThePixelsWhoseCentreIsInIt) {
  image::Grid fine = gridIn(PatientPlane::Axial, 0.0);
  image::Grid coarse = fine;
  coarse.spacing_mm = 2.0 * fine.spacing_mm;
  coarse.size = {4, 4, 3};
  coarse.origin_lps_mm = fine.indexToLps({0.5, 0.5, 0.5});  // each voxel holds eight of the fine ones
  image::Mask region(coarse);
  region.at(1, 1, 1) = 1;
  const auto edges = cutOf(region, fine, 2);
  ASSERT_EQ(edges.size(), 4u);
  for (const BorderEdge& e : edges)
    for (const Eigen::Vector2d& p : {e.from, e.to})
      EXPECT_TRUE((p.x() == 1.5 || p.x() == 3.5) && (p.y() == 1.5 || p.y() == 3.5)) << p.transpose();
  EXPECT_TRUE(cutOf(region, fine, 4).empty());
}

}  // namespace
}  // namespace glisson::tools
