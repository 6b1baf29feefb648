// SPDX-License-Identifier: GPL-3.0-or-later

// Whether linear theory can be trusted, in millimetres, and models that cannot bend as their body does.
#include "retraction/linear_gap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "retraction/discretisation.h"
#include "retraction/simulate.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;
using testing::Contains;
using testing::HasSubstr;

Model box(const Eigen::Vector3i& cells, const Vector3d& size_mm, double poisson, double E_kPa = 12) {
  image::Grid g;
  g.size = cells;
  g.spacing_mm = size_mm.cwiseQuotient(cells.cast<double>());
  g.origin_lps_mm = 0.5 * g.spacing_mm;
  return makeModel(image::ScalarVolume(g, static_cast<float>(E_kPa)), poisson, defaults::liverDensity, false);
}

retraction::Setup pulled(const Vector3d& kPa, double poisson) {
  retraction::Setup s;
  s.poisson = poisson;
  SupportSpec clamp;
  clamp.region = FaceRegion{"x-"};
  s.supports = {clamp};
  s.loads = {Traction{FaceRegion{"x+"}, kPa}};
  return s;
}

TEST(LinearGapInMm, DecidesWhatIsTrusted) {
  // A cantilever of 200 × 10 × 10 mm: by 2 mm at the tip linear theory is right to .02 mm, by 20 mm it misses 2 mm.
  const Model m = box({40, 2, 2}, {200, 10, 10}, 0.0);
  for (const auto& [tip_mm, trusted] : {std::pair{2.0, true}, {20.0, false}}) {
    // Tip of a slender cantilever under a shear stress t over its end: 4 t L³ / (E h²).
    retraction::Setup s = pulled({0, 0, -tip_mm * 12 * 100 / (4 * 200.0 * 200 * 200)}, 0.0);
    Result r = simulate(m, s, {});
    ASSERT_NEAR(r.max_displacement_mm, tip_mm, 0.05 * tip_mm);
    const std::vector<Vector3d> landmarks = {{10, 5, 5}, {190, 5, 5}, {-40, 0, 0}};
    judgeByGap(m, s, landmarks, r);
    const std::size_t said = r.validity.size();
    judgeByGap(m, s, landmarks, r);
    EXPECT_EQ(r.validity.size(), said) << "said once";
    ASSERT_TRUE(r.linearGap && r.linearGap->known);
    EXPECT_EQ(kinematicsValid(r), trusted) << tip_mm;
    EXPECT_TRUE(r.linearTrusted);
    EXPECT_LE(r.linearGap->mean_mm, r.linearGap->max_mm);
    EXPECT_LE(*r.linearGap->landmarks_max_mm, r.linearGap->max_mm);
    EXPECT_GE(*r.linearGap->landmarks_max_mm, 0.8 * r.linearGap->max_mm);
    s.kinematics = Kinematics::Corotational;
    const Result large = simulate(m, s, {});
    const double missed_mm = 1e3 * (large.nodal_u_m - r.nodal_u_m).colwise().norm().maxCoeff();
    EXPECT_NEAR(r.linearGap->max_mm, missed_mm, 0.25 * missed_mm);
    if (!trusted) {
      EXPECT_THAT(r.validity, Contains(HasSubstr("linear theory misses up to")));
    }
    // Near its landmarks at the clamp it misses little whatever the tip does.
    EXPECT_TRUE(linearGap(m, pulled({0, 0, 0}, 0.0), r, {{5, 5, 5}}).trusted());
    EXPECT_TRUE(kinematicsValid(large));
    EXPECT_THROW(linearGap(m, s, large, {}), BadArgument);
  }
}

TEST(LinearGapInMm, IsNearlyTheSameOnLargerCells) {
  // A curved body on a bed, pulled aside; its grid is odd, so that larger cells stand out of it.
  image::Grid g;
  g.size = {31, 23, 19};
  g.spacing_mm = Vector3d::Constant(5);
  image::ScalarVolume E(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        if (Vector3d((i - 15.0) / 15.5, (j - 11.0) / 11.5, (k - 9.0) / 9.5).norm() < 1) E.at(i, j, k) = 5.0F;
  const Model m = makeModel(std::move(E), 0.45, defaults::liverDensity, false);
  retraction::Setup s;
  s.poisson = 0.45;
  SupportSpec bed;
  bed.kind = SupportSpec::Kind::Spring;
  bed.region = SurfaceRegion{"posterior"};
  bed.stiffness_kPa_per_mm = 0.05;
  s.supports = {bed};
  s.loads = {BodyForce{{2500, -1000, 4000}}};
  const Result r = simulate(m, s, {});
  const std::vector<Vector3d> landmarks = {{75, 55, 45}, {20, 55, 45}, {120, 40, 60}};
  const LinearGap fine = linearGap(m, s, r, landmarks), coarse = linearGap(m, s, r, landmarks, {}, 9000);
  ASSERT_TRUE(fine.known && coarse.known) << fine.why << coarse.why;
  EXPECT_GT(fine.mean_mm, 0.01);
  EXPECT_NE(fine.mean_mm, coarse.mean_mm);
  EXPECT_NEAR(coarse.mean_mm, fine.mean_mm, 0.25 * fine.mean_mm);
  EXPECT_NEAR(*coarse.landmarks_max_mm, *fine.landmarks_max_mm, 0.25 * *fine.landmarks_max_mm);
}

TEST(LinearGapInMm, SaysThatAColumnBuckles) {
  const Model m = box({40, 2, 2}, {200, 10, 10}, 0.0);
  const double euler_kPa = std::pow(std::numbers::pi / 2, 2) * 12 * 100 / 12 / (200.0 * 200);
  retraction::Setup s = pulled({-1.2 * euler_kPa, 0, 0}, 0.0);
  Result r = simulate(m, s, {});
  EXPECT_TRUE(r.linearTrusted) << "strains and rotations are small";
  judgeByGap(m, s, {}, r);
  EXPECT_FALSE(r.linearTrusted);
  EXPECT_FALSE(kinematicsValid(r));
  EXPECT_THAT(r.validity, Contains(HasSubstr("buckle")));
  s.loads = {Traction{FaceRegion{"x+"}, {-0.5 * euler_kPa, 0, 0}}};
  r = simulate(m, s, {});
  judgeByGap(m, s, {}, r);
  EXPECT_TRUE(kinematicsValid(r));
}

TEST(LinearGapInMm, OfQuadraticTetrahedraIsThatOfHexahedraNearIncompressibility) {
  const Model m = box({12, 4, 4}, {60, 20, 20}, 0.4999);
  const auto gapOf = [&](ModelKind kind) {
    retraction::Setup s = pulled({0, 0, -0.02}, 0.4999);
    s.model.kind = kind;
    s.model.quadraticTets = true;
    Result r = simulate(m, s, {});
    judgeByGap(m, s, {}, r);
    EXPECT_TRUE(r.linearGap->known) << r.linearGap->why;
    return *r.linearGap;
  };
  const LinearGap tets = gapOf(ModelKind::FemTet), hexes = gapOf(ModelKind::FemHex);
  EXPECT_EQ(tets.stability, mechanics::Stability::Stable);
  EXPECT_NEAR(tets.max_mm, hexes.max_mm, 0.35 * hexes.max_mm);
}

TEST(ErrorOfLockingElements, IsUnknownAndBBarIsAskedInstead) {
  const Model m = box({20, 4, 4}, {50, 10, 10}, 0.4999);
  for (const bool tetrahedra : {false, true}) {
    retraction::Setup s = pulled({0, 0, -0.005}, 0.4999);
    s.model.kind = tetrahedra ? ModelKind::FemTet : ModelKind::FemHex;
    s.model.element = mechanics::HexElement::H8;
    const DiscretisationError e = discretisationError(m, s, simulate(m, s, {}));
    EXPECT_FALSE(e.known);
    EXPECT_THAT(e.note, HasSubstr("B-bar"));
    EXPECT_THAT(e.note, HasSubstr("H8-Bbar"));
  }
  retraction::Setup s = pulled({0, 0, -0.005}, 0.4999);
  EXPECT_TRUE(discretisationError(m, s, simulate(m, s, {})).known);
}

TEST(ErrorOfThinBodies, IsThatOfHalfCells) {
  // Two cells through a beam; the truth from cells of an eighth.
  const Model m = box({10, 2, 2}, {50, 10, 10}, 0.45);
  const retraction::Setup s = pulled({0, 0, -0.05}, 0.45);
  const Result r = simulate(m, s, {});
  const DiscretisationError e = discretisationError(m, s, r);
  ASSERT_TRUE(e.known) << e.note;
  const Model fine = refined(refined(refined(m)));
  const Result truth = simulate(fine, s, {});
  double mean = 0, most = 0;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k) {
        const std::vector<Vector3d> p = {{5.0 * i + 2.5, 5.0 * j + 2.5, 5.0 * k + 2.5}};
        const double d = (displacementAt(m, r, p)[0] - displacementAt(fine, truth, p)[0]).norm();
        mean += d / 40;
        most = std::max(most, d);
      }
  EXPECT_LE(mean, e.mean_mm);
  EXPECT_LE(most, e.max_mm);
  EXPECT_GE(mean, e.mean_mm / 3);
  EXPECT_GE(most, e.max_mm / 3);
}

TEST(MovingLeastSquares, ThatCannotBendAreNoAnswer) {
  // A plate of two cells: bent by finite elements and by affine frames, hardly by moving least squares.
  const Model plate = box({30, 30, 2}, {60, 60, 4}, 0.3), block = box({15, 10, 10}, {60, 40, 40}, 0.3);
  retraction::Setup s = pulled({0, 0, -1e-4}, 0.3);
  const double right_mm = simulate(plate, s, {}).max_displacement_mm;
  s.model.kind = ModelKind::Meshfree;
  s.model.meshfree.frames = 200;
  for (const int order : {1, 2}) {
    s.model.meshfree.kernel = mechanics::Kernel::Mls;
    s.model.meshfree.order = order;
    const Result r = simulate(plate, s, {});
    if (r.max_displacement_mm < 0.8 * right_mm) {
      EXPECT_FALSE(r.drawable) << order << ": " << r.max_displacement_mm << " of " << right_mm;
      EXPECT_FALSE(r.linearTrusted);
      EXPECT_THAT(r.validity, Contains(HasSubstr("cannot bend")));
    }
    EXPECT_TRUE(simulate(block, s, {}).drawable) << order;
  }
  s.model.meshfree.order = 1;
  EXPECT_LT(simulate(plate, s, {}).max_displacement_mm, 0.8 * right_mm);
}

TEST(Wendland, OnASlenderBeamIsConvergedAtItsRounding) {
  // A beam of 200:1, which bends by its own width and more; the residual cannot fall below rounding.
  const Model m = box({200, 1, 1}, {200, 1, 1}, 0.0);
  retraction::Setup s;
  s.poisson = 0.0;
  SupportSpec clamp;
  clamp.region = FaceRegion{"x-"};
  s.supports = {clamp};
  s.loads = {BodyForce{{0, 0, -0.025}}};
  const Result voxels = simulate(m, s, {});
  s.model.kind = ModelKind::Meshfree;
  s.model.meshfree.kernel = mechanics::Kernel::Wendland;
  s.model.meshfree.order = 2;
  s.model.meshfree.frames = 60;
  const Result r = simulate(m, s, {});
  EXPECT_TRUE(r.solver.converged()) << r.solver.residual;
  EXPECT_NEAR(r.max_displacement_mm, voxels.max_displacement_mm, 0.03 * voxels.max_displacement_mm);
}

}  // namespace
}  // namespace glisson::retraction
