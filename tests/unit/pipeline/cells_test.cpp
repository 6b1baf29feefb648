// SPDX-License-Identifier: GPL-3.0-or-later

// The body in cells larger than the mask's voxels has the mask's volume, and with it its weight.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "image/io.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

using Eigen::Vector3d;

image::Mask ellipsoid(const Vector3d& semi_mm, const Eigen::Matrix3d& axes) {
  image::Grid g;
  g.spacing_mm = {2.0, 2.0, 3.0};
  g.direction = axes;
  for (int a = 0; a < 3; ++a) g.size[a] = 2 * static_cast<int>(std::ceil(semi_mm.maxCoeff() / g.spacing_mm[a])) + 2;
  g.origin_lps_mm = -axes * (0.5 * g.spacing_mm.cwiseProduct((g.size.cast<double>().array() - 1.0).matrix()));
  image::Mask mask(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        mask.at(i, j, k) = g.indexToLps(Vector3d(i, j, k)).cwiseQuotient(semi_mm).norm() < 1 ? 1 : 0;
  return mask;
}

class Cells : public testing::Test {
 protected:
  /// Volume of the body in cubes of that edge over the volume of the mask's voxels, less one, in percent.
  double off_pct(const image::Mask& mask, double cell_mm) {
    image::writeVolume(folder_ / "body.nii.gz", mask);
    const Scene s = parseScene(
        R"({ "schema": "glisson/scene/1", "geometry": { "kind": "mask", "file": "body.nii.gz", "cell_mm": )" +
            std::to_string(cell_mm) + R"( }, "material": { "youngs_kPa": 6 },
        "supports": [ { "region": {"surface":"all"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1 } ],
        "loads": [ { "kind": "body_force", "N_per_m3": [0,-100,0] } ] })",
        folder_.path());
    RunOptions options;
    options.discretisation = false;
    double voxels = 0;
    for (const auto v : mask.values) voxels += v ? 1 : 0;
    return 100.0 * (1e3 * run(s, options).model.volume_mL / (voxels * mask.grid.voxelVolume_mm3()) - 1.0);
  }
  test::TemporaryFolder folder_;
};

TEST_F(Cells, KeepTheVolumeOfABallAndOfAFlatBody) {
  const Eigen::Matrix3d oblique = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), oblique})
    for (const Vector3d& semi_mm : {Vector3d(60, 60, 60), Vector3d(80, 60, 25)})
      EXPECT_LT(std::abs(off_pct(ellipsoid(semi_mm, axes), 4.0)), 0.5) << semi_mm.transpose();
}

TEST_F(Cells, KeepTheVolumeOfALiver) {
  const image::Mask liver = phantom::makePhantom(3).liver;
  for (const double cell_mm : {4.0, 2.0 * liver.grid.spacing_mm.x()})
    EXPECT_LT(std::abs(off_pct(liver, cell_mm)), 0.2) << cell_mm;
}

}  // namespace
}  // namespace glisson::pipeline
