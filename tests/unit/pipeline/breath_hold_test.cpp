// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/breath_hold.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/io.h"
#include "pipeline/scene.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

image::ScalarVolume blobs(const Eigen::Vector3d& shift_mm, double slice_mm, int slices, bool inverted) {
  image::Grid g;
  g.size = {60, 56, slices};
  g.spacing_mm = {3.0, 3.0, slice_mm};
  g.origin_lps_mm = {-90, -84, -0.5 * slice_mm * (slices - 1)};
  image::ScalarVolume v(g);
  const auto blob = [](const Eigen::Vector3d& p, const Eigen::Vector3d& c, double r) {
    return 1.0 / (1.0 + std::exp(0.4 * ((p - c).norm() - r)));
  };
  for (int k = 0; k < slices; ++k)
    for (int j = 0; j < 56; ++j)
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d p = g.indexToLps({double(i), double(j), double(k)}) - shift_mm;
        const double t = 100 * blob(p, {0, 0, 0}, 70) + 90 * blob(p, {-25, 5, 5}, 32) - 60 * blob(p, {30, -20, 0}, 14) +
                         120 * blob(p, {20, 30, -4}, 12);
        v.at(i, j, k) = static_cast<float>(inverted ? 500.0 - t : t);
      }
  return v;
}

// Elastogram and magnitude of a breath-hold 6 mm lower: both go back, the values stay as they are.
TEST(FitToMri, MovesMapAndConfidenceBackAndCanBeUndone) {
  test::TemporaryFolder folder;
  const image::ScalarVolume mri = blobs({0, 0, 0}, 4.0, 30, false);
  const image::ScalarVolume magnitude = blobs({2.0, -3.0, -6.0}, 8.0, 12, true);
  image::writeVolume(folder / "magnitude.nii.gz", magnitude);
  image::writeVolume(folder / "map.nii.gz", magnitude);
  LoadedStiffness mre = loadStiffness(folder / "map.nii.gz", {StiffnessQuantity::Shear, "Pa"});
  mre.map.confidence = image::ScalarVolume(mre.map.values_kPa.grid, 1.0F);
  const image::Grid before = mre.map.values_kPa.grid;
  const std::vector<float> values = mre.map.values_kPa.values;
  const elastography::Registration r = fitToMri(mre, folder / "map.nii.gz", folder / "magnitude.nii.gz", mri);
  EXPECT_LT((r.X_fixed_moving * Eigen::Vector3d(2.0, -3.0, -6.0)).norm(), 0.5);
  EXPECT_EQ(mre.map.values_kPa.values, values);
  EXPECT_TRUE(mre.map.confidence->grid.sameGeometry(mre.map.values_kPa.grid));
  EXPECT_FALSE(before.sameGeometry(mre.map.values_kPa.grid));
  EXPECT_TRUE(elastography::moved(mre.map.values_kPa.grid, r.X_fixed_moving.inverse()).sameGeometry(before));
  EXPECT_EQ(mre.warnings.back(), elastography::describe(r));
  EXPECT_THROW(fitToMri(mre, folder / "map.nii.gz", {}, mri), BadInput);
}

TEST(Scene, RegistrationIsOffUnlessAskedFor) {
  test::TemporaryFolder folder;
  image::writeVolume(folder / "a.nii.gz", blobs({0, 0, 0}, 4.0, 3, false));
  const std::string start =
      R"({"schema":"glisson/scene/1","geometry":{"kind":"patient","mri":"a.nii.gz","mre":"a.nii.gz","roi":"a.nii.gz")";
  const std::string end =
      R"(},"material":"mre","supports":[{"region":{"face":"z-"},"kind":"fixed"}],"loads":[{"kind":"body_force","N_per_m3":[0,0,-1]}]})";
  EXPECT_FALSE(parseScene(start + end, folder.path()).geometry.rigidRegistration);
  const Scene on = parseScene(start + R"(,"registration":"rigid")" + end, folder.path());
  EXPECT_TRUE(on.geometry.rigidRegistration);
  EXPECT_TRUE(parseScene(toJson(on), folder.path()).geometry.rigidRegistration);
  EXPECT_THROW(parseScene(start + R"(,"registration":"elastic")" + end, folder.path()), BadInput);
}

}  // namespace
}  // namespace glisson::pipeline
