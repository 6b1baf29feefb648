// SPDX-License-Identifier: GPL-3.0-or-later

// What linear theory misses, against answers of large-deformation solvers and closed forms.
#include "mechanics/linear_gap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "mechanics/newton_solve.h"
#include "mechanics/static_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;

constexpr double E_Pa = 12e3;

/// A beam or column clamped at x = 0 with a traction on its end face.
Problem beam(const Eigen::Vector3i& n, const Vector3d& size_m, const Vector3d& traction_Pa, double poisson = 0.0) {
  Problem p;
  p.body = test::box(n, size_m, E_Pa, poisson);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = fix(test::nodesWhere(mesh, [](const auto& x) { return x.x() < 1e-9; }));
  p.f_N = tractionForce(mesh, test::facesWhere(mesh, 1, [](const auto&) { return true; }), traction_Pa);
  return p;
}

SolverOptions tight() {
  SolverOptions o;
  o.tolerance = 1e-10;
  return o;
}

double largest_mm(const NodalField& d_m) {
  return 1e3 * d_m.colwise().norm().maxCoeff();
}

/// The gap of a problem, and the true one: corotational less linear.
struct Compared {
  LinearGap gap;
  double said_mm, true_mm;
  explicit Compared(const Problem& p) {
    const Solution linear = solveStatic(p, tight());
    gap = linearGap(p, linear.u_m);
    said_mm = gap.computed ? largest_mm(gap.correction_m) : -1.0;
    const Solution large = solveLargeDeformation(p, LargeDeformationKind::Corotational, tight());
    EXPECT_TRUE(large.report.converged());
    true_mm = largest_mm(large.u_m - linear.u_m);
  }
};

TEST(LinearGap, OfBentBeamsIsThatOfTheCorotationalAnswer) {
  // Tip rotations of about 4, 8 and 15 degrees: linear theory misses 0.2 to 3.5 mm, and its own limits say nothing or
  // "1 %".
  for (const double tip : {0.05, 0.1, 0.18}) {
    const Vector3d size(0.2, 0.005, 0.005);
    const double stress = tip * 0.25 * E_Pa * size.z() * size.z() / (size.x() * size.x());
    for (const Eigen::Vector3i& n : {Eigen::Vector3i(40, 2, 2), Eigen::Vector3i(80, 4, 4)}) {
      const Compared c(beam(n, size, {0, 0, -stress}));
      ASSERT_TRUE(c.gap.computed) << c.gap.why;
      EXPECT_EQ(c.gap.stability, Stability::Stable);
      EXPECT_NEAR(c.said_mm, c.true_mm, 0.2 * c.true_mm) << tip;
    }
  }
}

TEST(LinearGap, OfAStretchedBlockIsThatOfTheCorotationalAnswer) {
  for (const double strain : {-0.099, -0.05, 0.05, 0.099}) {
    const Compared c(beam({8, 8, 8}, {0.2, 0.2, 0.2}, {strain * E_Pa, 0, 0}, 0.45));
    ASSERT_TRUE(c.gap.computed) << c.gap.why;
    EXPECT_NEAR(c.said_mm, c.true_mm, 0.25 * c.true_mm + 1e-6) << strain;
  }
}

TEST(LinearGap, GrowsTowardsTheEulerLoadAndIsUnstableBeyondIt) {
  // Compressed along the axis, a hundredth of the load across.
  const Vector3d size(0.1, 0.01, 0.01);
  const double euler = std::pow(std::numbers::pi / 2, 2) * E_Pa * size.z() * size.z() / 12 / (size.x() * size.x());
  for (const Eigen::Vector3i& n : {Eigen::Vector3i(30, 3, 3), Eigen::Vector3i(50, 6, 6)}) {
    double before = 0;
    for (const double share : {0.3, 0.6, 0.9}) {
      const Compared c(beam(n, size, {-share * euler, 0, 0.001 * share * euler}));
      ASSERT_TRUE(c.gap.computed) << share << ": " << c.gap.why;
      EXPECT_EQ(c.gap.stability, Stability::Stable);
      EXPECT_GT(c.said_mm, before);
      EXPECT_NEAR(c.said_mm, c.true_mm, 0.4 * c.true_mm) << share;
      before = c.said_mm;
    }
    for (const double share : {1.1, 1.2, 1.5})
      for (const double across : {0.0, 0.001}) {
        const Problem p = beam(n, size, {-share * euler, 0, across * share * euler});
        const LinearGap gap = linearGap(p, solveStatic(p, tight()).u_m);
        EXPECT_EQ(gap.stability, Stability::Unstable) << share << ", " << across << ", " << n.transpose();
        EXPECT_FALSE(gap.computed);
      }
  }
}

TEST(LinearGap, IsNothingWithoutLoadAndQuadraticInASmallOne) {
  const Vector3d size(0.2, 0.02, 0.02);
  const Problem p = beam({30, 4, 4}, size, {0, 0, -0.01});
  const NodalField u_m = solveStatic(p, tight()).u_m;
  EXPECT_EQ(linearGap(p, NodalField::Zero(3, u_m.cols())).correction_m, NodalField::Zero(3, u_m.cols()));
  const double one = largest_mm(linearGap(p, u_m).correction_m),
               half = largest_mm(linearGap(p, 0.5 * u_m).correction_m);
  EXPECT_NEAR(half, 0.25 * one, 0.01 * one);
}

TEST(LinearGap, SaysWhyItIsNotThere) {
  const Problem p = beam({6, 2, 2}, {0.03, 0.01, 0.01}, {0, 0, -1});
  NodalField folded = solveStatic(p).u_m;
  const VoxelMesh mesh(p.body);
  for (int node = 0; node < mesh.nodeCount(); ++node) folded(0, node) = -2 * mesh.position_m(node).x();
  const LinearGap gap = linearGap(p, folded);
  EXPECT_FALSE(gap.computed);
  EXPECT_NE(gap.why.find("inside out"), std::string::npos);
  EXPECT_THROW(linearGap(p, NodalField::Zero(3, 4)), BadArgument);
  Problem adrift = p;
  adrift.supports = {};
  const LinearGap none = linearGap(adrift, NodalField::Zero(3, mesh.nodeCount()));
  EXPECT_EQ(none.stability, Stability::Unknown);
  EXPECT_EQ(none.why, "the body is not held");
}

}  // namespace
}  // namespace glisson::mechanics
