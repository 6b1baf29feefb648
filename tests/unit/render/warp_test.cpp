// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/random.h"
#include "render/overlay.h"
#include "render/sampling.h"
#include "scene_fixture.h"

namespace glisson::render {
namespace {

image::Grid obliqueGrid() {
  image::Grid grid;
  grid.size = {30, 26, 18};
  grid.spacing_mm = {1.5, 2.0, 3.0};
  grid.origin_lps_mm = {-20.0, 13.0, 40.0};
  grid.direction = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()))
                       .toRotationMatrix();
  grid.direction.col(2) *= -1.0;  // flipped
  return grid;
}

image::ScalarVolume noise(const image::Grid& grid) {
  image::ScalarVolume v(grid);
  Random random(5);
  for (float& x : v.values) x = static_cast<float>(random.uniform(0.0, 100.0));
  return v;
}

/// Moving by a whole number of voxels moves the values, exactly, on an oblique flipped anisotropic grid.
TEST(Warp, translationByWholeVoxelsIsExact) {
  const image::Grid grid = obliqueGrid();
  const image::ScalarVolume image = noise(grid);
  const Eigen::Vector3i step(2, -1, 3);
  const Eigen::Vector3d t = grid.direction * grid.spacing_mm.cwiseProduct(step.cast<double>());
  const image::DisplacementField u(grid, t.cast<float>());
  const image::ScalarVolume moved = warp(image, u, grid);
  int compared = 0;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const Eigen::Vector3i from = Eigen::Vector3i(i, j, k) - step;
        if (!grid.contains(from)) continue;
        EXPECT_NEAR(moved.at(i, j, k), image.at(from), 1e-2);
        ++compared;
      }
  EXPECT_EQ(compared, 28 * 25 * 15);
}

/// A linear image is tri-linear, so any translation is exact up to rounding, whole voxels or not.
TEST(Warp, anyTranslationOfALinearImageIsExact) {
  const image::Grid grid = obliqueGrid();
  image::ScalarVolume image(grid);
  const Eigen::Vector3d slope(0.7, -1.1, 0.4), t(1.3, -2.2, 0.9);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        image.at(i, j, k) = static_cast<float>(slope.dot(grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k})));
  const image::ScalarVolume moved = warp(image, image::DisplacementField(grid, t.cast<float>()), grid);
  for (int k = 3; k < 15; ++k)
    for (int j = 4; j < 22; ++j)
      for (int i = 4; i < 26; ++i)
        EXPECT_NEAR(moved.at(i, j, k), slope.dot(grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k}) - t), 1e-3);
}

/// x -> y = x + u(x) -> x: the inverse of a smooth field with strains up to 0.5 comes back to within 0.05 voxel.
TEST(Warp, inverseComesBack) {
  image::Grid grid = obliqueGrid();
  image::DisplacementField u(grid, Eigen::Vector3f::Zero());
  const auto field = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(4.0 * std::sin(p.y() / 12.0), 5.0 * std::cos(p.x() / 13.0 + p.z() / 20.0),
                           3.0 * std::sin(p.x() / 9.0));
  };
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        u.at(i, j, k) = field(grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k})).cast<float>();
  const InverseMap inverse(u, true);
  Random random(11);
  for (int n = 0; n < 2000; ++n) {
    const Eigen::Vector3d x = grid.indexToLps({random.uniform(5, 24), random.uniform(5, 20), random.uniform(3, 14)});
    const InverseMap::Result back = inverse.rest(x + inverse.at(x));
    EXPECT_LT((back.x_lps - x).norm(), 0.05 * grid.spacing_mm.minCoeff());
  }
}

/// A fold (u jumps by more than a voxel) has no inverse there: the nearest iterate is taken and all values stay finite.
TEST(Warp, foldsStayFinite) {
  const image::Grid grid = obliqueGrid();
  image::DisplacementField u(grid, Eigen::Vector3f::Zero());
  Random random(3);
  for (Eigen::Vector3f& v : u.values)
    v = Eigen::Vector3d(random.normal(), random.normal(), random.normal()).cast<float>() * 20.0F;
  for (const float v : warp(noise(grid), u, grid).values) EXPECT_TRUE(std::isfinite(v));
}

/// Tissue stretched to three times its length, and a fold of what lies beside it over it: iterations for the inverse do
/// not converge or end in the fold, the cells hold every place.
TEST(Warp, materialThatIsStretchedOrFoldedIsFoundByItsCells) {
  image::Grid grid = obliqueGrid();
  image::ScalarVolume mask(grid);
  image::DisplacementField u(grid, Eigen::Vector3f::Zero());
  const Eigen::Vector3d along = grid.direction.col(0);
  // Along i: at rest up to voxel 9, then stretched, then carried as a whole; a fold between 20 and 23.
  const auto shift_mm = [](double i) {
    return i < 9 ? 0.0 : i < 15 ? 3.0 * (i - 9) : i < 20 ? 18.0 : i < 23 ? 18.0 - 4.0 * (i - 20) : 6.0;
  };
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        u.at(i, j, k) = (shift_mm(i) * along).cast<float>();
        mask.at(i, j, k) = i > 2 && i < 19 ? 1.0F : 0.0F;
      }
  const InverseMap blind(u, true), inverse(u, true, mask);
  Random random(7);
  int lost = 0;
  for (int n = 0; n < 2000; ++n) {
    const Eigen::Vector3d index(random.uniform(4, 18), random.uniform(5, 20), random.uniform(3, 14));
    const Eigen::Vector3d x = grid.indexToLps(index), y = x + inverse.at(x);
    const InverseMap::Result back = inverse.rest(y);
    ASSERT_TRUE(back.found) << index.transpose();
    // In the fold other material lies at the same place: what is found is there, and of the mask.
    EXPECT_LT((back.x_lps + inverse.at(back.x_lps) - y).norm(), 0.05);
    EXPECT_LT((back.x_lps - x).norm(), 0.05) << index.transpose();
    const InverseMap::Result other = blind.rest(y);
    if (!other.found || (other.x_lps - x).norm() > 0.1) ++lost;
  }
  EXPECT_GT(lost, 50) << "the test asks for nothing that iterations cannot do";
}

TEST(Warp, sameBitsWithAnyNumberOfThreads) {
  const test::SceneForms forms{[](const auto& p) { return p.norm() < 60; },
                               [](const auto& p) { return static_cast<float>(p.x()); },
                               [](const auto& p) { return Eigen::Vector3d(p.y() / 10, 3, p.x() / 12); },
                               [](const auto&) { return Eigen::Vector3d(1, 2, 3); }};
  const RetractionScene scene = test::sceneFrom(obliqueGrid(), forms);
  setThreadCount(1);
  const auto one = warp(scene.mri, scene.u_mre_mm, scene.mri.grid);
  setThreadCount(5);
  const auto five = warp(scene.mri, scene.u_mre_mm, scene.mri.grid);
  setThreadCount(0);
  EXPECT_EQ(one.values, five.values);
}

/// The extension leaves known values alone and carries a constant on unchanged.
TEST(Extension, constantGoesOn) {
  image::Grid grid = obliqueGrid();
  image::ScalarVolume mask(grid);
  image::DisplacementField u(grid, Eigen::Vector3f::Zero());
  for (int k = 6; k < 12; ++k)
    for (int j = 8; j < 18; ++j)
      for (int i = 8; i < 20; ++i) {
        mask.at(i, j, k) = 1.0F;
        u.at(i, j, k) = Eigen::Vector3f(1.5F, -2.0F, 0.5F);
      }
  const image::DisplacementField out = extended(u, mask, 9.0);
  EXPECT_EQ(out.at(10, 10, 8), u.at(10, 10, 8));
  EXPECT_LT((out.at(2, 10, 8) - u.at(10, 10, 8)).norm(), 1e-5F);
  EXPECT_EQ(out.at(0, 10, 8), Eigen::Vector3f(0, 0, 0)) << "8 voxels away lies beyond the reach of 6";
}

}  // namespace
}  // namespace glisson::render
