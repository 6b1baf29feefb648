// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "retraction/simulate.h"

// What a scene may ask for beyond linear voxels: tetrahedra, and large deformation.
namespace glisson::retraction {
namespace {

using Eigen::Vector3d;

Model bar(const Eigen::Vector3i& cells, const Vector3d& size_mm, double E_kPa, double poisson) {
  image::Grid g;
  g.size = cells;
  g.spacing_mm = size_mm.cwiseQuotient(cells.cast<double>());
  g.origin_lps_mm = 0.5 * g.spacing_mm;
  return makeModel(image::ScalarVolume(g, static_cast<float>(E_kPa)), poisson, defaults::liverDensity, false);
}

/// Clamped at x−, pushed along −z at x+.
Setup cantilever(double poisson, double kPa) {
  Setup s;
  s.poisson = poisson;
  SupportSpec clamp;
  clamp.region = FaceRegion{"x-"};
  s.supports.push_back(clamp);
  s.loads.push_back(Traction{FaceRegion{"x+"}, {0, 0, -kPa}});
  return s;
}

std::string refusal(const Setup& s) {
  try {
    simulate(bar({4, 2, 2}, {40, 20, 20}, 6, 0.3), s, {});
  } catch (const BadInput& e) {
    return e.what();
  }
  return "not refused";
}

TEST(Kinematics, LargeDeformationIsLinearForSmallLoadsAndStaysGoodWhereLinearTheoryEnds) {
  const Model m = bar({24, 4, 4}, {60, 10, 10}, 10, 0.45);
  const Vector3d tip(60, 5, 5);
  for (const Kinematics kinematics : {Kinematics::Corotational, Kinematics::Hyperelastic}) {
    retraction::Setup s = cantilever(0.45, 1e-4);
    const Result linear = simulate(m, s, {tip});
    s.kinematics = kinematics;
    const Result small = simulate(m, s, {tip});
    ASSERT_TRUE(small.solver.converged());
    EXPECT_EQ(small.kinematics, kinematics);
    EXPECT_THAT(small.solver.kind, testing::HasSubstr("newton"));
    EXPECT_NEAR(small.probe_u_mm[0].z(), linear.probe_u_mm[0].z(),
                (kinematics == Kinematics::Corotational ? 1e-3 : 0.03) * std::abs(linear.probe_u_mm[0].z()));
    EXPECT_EQ(small.dofs, linear.dofs);

    retraction::Setup far = cantilever(0.45, 0.15);
    const Result wrong = simulate(m, far, {tip});
    far.kinematics = kinematics;
    const Result right = simulate(m, far, {tip});
    ASSERT_TRUE(right.solver.converged()) << right.solver.why;
    EXPECT_FALSE(wrong.linearTrusted);
    EXPECT_GT(right.max_rotation_deg, 30);
    EXPECT_LT(-right.probe_u_mm[0].z(), 0.8 * -wrong.probe_u_mm[0].z());
    EXPECT_LT(right.probe_u_mm[0].x(), -5) << "the end of a bent bar comes nearer; in linear theory it does not";
    EXPECT_LT(right.max_strain, wrong.max_strain) << "no rotation is counted as strain";
    EXPECT_TRUE(right.drawable);
    for (const std::string& v : right.validity) EXPECT_THAT(v, testing::Not(testing::HasSubstr("linear elasticity")));
    EXPECT_EQ(right.linearTrusted, kinematics == Kinematics::Hyperelastic || right.p95_strain < 0.10);
    EXPECT_LE((right.load_N + right.reaction_N).norm(), 1e-6 * right.load_N.norm());
  }
}

TEST(Kinematics, WhatCannotBeAppliedIsMarked) {
  // Crushed: a corotational bar (small strain) would need more than its length.
  retraction::Setup s = cantilever(0.0, 0);
  s.loads.clear();
  s.loads.push_back(Traction{FaceRegion{"x+"}, {-9, 0, 0}});
  s.kinematics = Kinematics::Corotational;
  const Result r = simulate(bar({4, 2, 2}, {40, 20, 20}, 6, 0.0), s, {});
  EXPECT_EQ(r.solver.status, mechanics::SolveStatus::StoppedAtLimit);
  EXPECT_FALSE(r.drawable);
  EXPECT_FALSE(r.linearTrusted);
  ASSERT_FALSE(r.validity.empty());
  EXPECT_THAT(r.validity[0], testing::HasSubstr("% of the load could be applied"));
  EXPECT_TRUE(r.nodal_u_m.allFinite());
}

TEST(Kinematics, TetrahedraAnswerOnTheVoxels) {
  const Model m = bar({20, 4, 4}, {50, 10, 10}, 12, 0.3);
  retraction::Setup s = cantilever(0.3, 0);
  s.loads.clear();
  s.loads.push_back(BodyForce{{0, 0, -12.8}});  // about 1 mm at the tip
  const Vector3d tip(50, 5, 5);
  const Result hexahedra = simulate(m, s, {tip});
  s.model.kind = ModelKind::FemTet;
  const Result linear = simulate(m, s, {tip});
  s.model.quadraticTets = true;
  const Result quadratic = simulate(m, s, {tip});
  ASSERT_TRUE(linear.solver.converged() && quadratic.solver.converged());
  EXPECT_EQ(linear.dofs, 3 * 21 * 5 * 5);
  EXPECT_EQ(quadratic.dofs, 3 * 41 * 9 * 9);
  EXPECT_EQ(quadratic.nodal_u_m.cols(), 21 * 5 * 5);
  const double u = hexahedra.probe_u_mm[0].z();
  EXPECT_NEAR(quadratic.probe_u_mm[0].z(), u, 0.015 * std::abs(u));
  EXPECT_GT(linear.probe_u_mm[0].z(), 0.95 * u) << "linear tetrahedra are stiff";
  for (const Result* r : {&linear, &quadratic}) {
    EXPECT_LE((r->load_N + r->reaction_N).norm(), 1e-7 * r->load_N.norm());
    EXPECT_TRUE(r->linearTrusted);
    EXPECT_THAT(r->notes, testing::Contains(testing::HasSubstr("tetrahedra")));
  }
}

TEST(Kinematics, WhatIsNotOfferedIsRefused) {
  retraction::Setup s = cantilever(0.3, 0.01);
  EXPECT_EQ(refusal(s), "not refused");
  s.kinematics = Kinematics::Corotational;
  EXPECT_EQ(refusal(s), "not refused");
  s.model.kind = ModelKind::Meshfree;
  EXPECT_THAT(refusal(s), testing::HasSubstr("\"fem-hex\" only"));
  s.model.kind = ModelKind::FemTet;
  EXPECT_THAT(refusal(s), testing::HasSubstr("\"fem-hex\" only"));
  s.model.kind = ModelKind::FemHex;
  s.analysis.dynamic = true;
  EXPECT_THAT(refusal(s), testing::HasSubstr("static"));
  s.analysis.dynamic = false;
  s.condensed = true;
  EXPECT_THAT(refusal(s), testing::HasSubstr("condensed"));
  s.kinematics = Kinematics::Linear;
  s.model.kind = ModelKind::FemTet;
  EXPECT_THAT(refusal(s), testing::HasSubstr("condensed"));
  s.condensed = false;
  s.analysis.dynamic = true;
  EXPECT_THAT(refusal(s), testing::HasSubstr("static"));
}

}  // namespace
}  // namespace glisson::retraction
