// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/registration.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace glisson::elastography {
namespace {

/// A body with organs of different brightness, in LPS mm; smooth borders.
double tissue(const Eigen::Vector3d& p) {
  const auto blob = [&](const Eigen::Vector3d& c, const Eigen::Vector3d& r) {
    const double d = (p - c).cwiseQuotient(r).norm();
    return 1.0 / (1.0 + std::exp(12.0 * (d - 1.0)));
  };
  return 60.0 * blob({0, 0, 0}, {95, 70, 90}) + 90.0 * blob({-35, -5, 5}, {42, 38, 34}) +
         140.0 * blob({45, 5, 12}, {16, 24, 22}) - 45.0 * blob({10, -30, -8}, {18, 12, 25}) +
         70.0 * blob({5, 42, 0}, {12, 10, 80}) + 60.0 * blob({-50, 15, -20}, {9, 7, 12});
}

image::Grid grid(Eigen::Vector3i size, Eigen::Vector3d spacing_mm, double tilt) {
  image::Grid g;
  g.size = size;
  g.spacing_mm = spacing_mm;
  g.direction = Eigen::AngleAxisd(tilt, Eigen::Vector3d(1, 0.3, 0.2).normalized()).toRotationMatrix();
  g.origin_lps_mm = -g.direction * spacing_mm.cwiseProduct(0.5 * (size.cast<double>() - Eigen::Vector3d::Ones()));
  return g;
}

/// The body seen on a grid after it moved by X: what was at p is at X p. Another contrast, noise.
image::ScalarVolume seen(const image::Grid& g, const Eigen::Isometry3d& X, bool otherContrast, double noise) {
  image::ScalarVolume v(g);
  Random random(11);
  const Eigen::Isometry3d back = X.inverse();
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const double t = tissue(back * g.indexToLps({double(i), double(j), double(k)}));
        v.at(i, j, k) = static_cast<float>((otherContrast ? 400.0 * std::exp(-t / 80.0) : t) + noise * random.normal());
      }
  return v;
}

Eigen::Isometry3d motion(const Eigen::Vector3d& shift_mm, double angle_deg, const Eigen::Vector3d& axis) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translate(shift_mm);
  X.rotate(Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, axis.normalized()));
  return X;
}

/// Largest distance by which the corners and the middle of the moving image are misplaced.
double worst_mm(const image::Grid& g, const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth) {
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d c(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Eigen::Vector3d p = g.indexToLps(c.cwiseProduct((g.size.array() - 1).matrix().cast<double>()));
    worst = std::max(worst, (found * p - truth * p).norm());
  }
  return worst;
}

TEST(Registration, KnownRigidMotionComesBackToHalfAMillimetre) {
  const image::ScalarVolume mri =
      seen(grid({96, 80, 40}, {2.2, 2.2, 4.5}, 0.0), Eigen::Isometry3d::Identity(), false, 3.0);
  const image::Grid g = grid({70, 60, 16}, {2.8, 2.8, 8.0}, 0.1);
  for (const Eigen::Isometry3d& X :
       {motion({7.3, -4.1, 9.5}, 0.0, {1, 0, 0}), motion({-3.2, 6.6, -5.1}, 4.0, {0.3, 0.2, 1})}) {
    const Registration r = registerRigid(mri, seen(g, X, true, 6.0));
    std::printf("%s; worst corner %.2f mm\n", describe(r).c_str(), worst_mm(g, r.X_fixed_moving, X.inverse()));
    EXPECT_TRUE(r.improved);
    EXPECT_EQ(r.motion, Motion::Rigid);
    EXPECT_GT(r.similarityAfter, r.similarityBefore);
    EXPECT_LT(worst_mm(g, r.X_fixed_moving, X.inverse()), 0.5);
    EXPECT_NEAR(r.rotation_deg, Eigen::AngleAxisd(X.rotation()).angle() * 180 / std::numbers::pi, 0.3);
    EXPECT_TRUE(moved(moved(g, r.X_fixed_moving), r.X_fixed_moving.inverse()).sameGeometry(g, 1e-9));
  }
}

TEST(Registration, FewThickSlicesMoveWithinTheirPlane) {
  const image::ScalarVolume mri =
      seen(grid({96, 80, 40}, {2.2, 2.2, 4.5}, 0.0), Eigen::Isometry3d::Identity(), false, 3.0);
  const image::Grid g = grid({120, 100, 4}, {1.64, 1.64, 10.0}, 0.1);
  const Eigen::Isometry3d X = motion(g.direction * Eigen::Vector3d(6.4, -8.3, 0.0), 0.0, {1, 0, 0});
  const Registration r = registerRigid(mri, seen(g, X, true, 6.0));
  EXPECT_EQ(r.motion, Motion::InPlane);
  EXPECT_LT(worst_mm(g, r.X_fixed_moving, X.inverse()), 0.5);
  EXPECT_LT(std::abs(g.direction.col(2).dot(r.X_fixed_moving.translation())), 1e-9);
  EXPECT_EQ(r.rotation_deg, 0.0);
}

TEST(Registration, WhatLiesRightStaysWithinNoise) {
  const image::ScalarVolume mri =
      seen(grid({96, 80, 40}, {2.2, 2.2, 4.5}, 0.0), Eigen::Isometry3d::Identity(), false, 3.0);
  const image::Grid g = grid({70, 60, 12}, {2.8, 2.8, 8.0}, 0.1);
  const Registration r = registerRigid(mri, seen(g, Eigen::Isometry3d::Identity(), true, 6.0));
  EXPECT_LT(worst_mm(g, r.X_fixed_moving, Eigen::Isometry3d::Identity()), 0.5);
}

TEST(Registration, SameBitsWithAnyNumberOfThreadsAndRefusals) {
  const image::ScalarVolume mri = seen(grid({50, 44, 20}, {4, 4, 8}, 0.0), Eigen::Isometry3d::Identity(), false, 3.0);
  const image::Grid g = grid({40, 36, 4}, {4, 4, 10.0}, 0.1);
  const image::ScalarVolume mre = seen(g, motion({4, 2, 0}, 0, {1, 0, 0}), true, 6.0);
  setThreadCount(1);
  const Registration one = registerRigid(mri, mre);
  setThreadCount(3);
  EXPECT_EQ(registerRigid(mri, mre).X_fixed_moving.matrix(), one.X_fixed_moving.matrix());
  setThreadCount(0);
  image::ScalarVolume far = mre;
  far.grid.origin_lps_mm.x() += 900;
  EXPECT_THROW(registerRigid(mri, far), BadInput);
  EXPECT_THROW(registerRigid(mri, image::ScalarVolume(g, 5.0F)), BadInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(registerRigid(mri, mre, {}, Progress({}, stop.get_token())), Cancelled);
}

}  // namespace
}  // namespace glisson::elastography
