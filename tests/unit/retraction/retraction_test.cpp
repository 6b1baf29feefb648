// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "comparison/difference.h"
#include "retraction/body.h"
#include "retraction/simulate.h"
#include "support/messages.h"
#include "support/support.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;
using test::messageOf;
using testing::HasSubstr;

/// A box of E kPa whose grid axes point along the columns of `direction`.
Model box(const Eigen::Vector3i& cells, const Vector3d& h_mm, double E_kPa, double poisson,
          const Eigen::Matrix3d& direction = Eigen::Matrix3d::Identity()) {
  image::Grid g;
  g.size = cells;
  g.spacing_mm = h_mm;
  g.direction = direction;
  g.origin_lps_mm = direction * (0.5 * h_mm);
  return makeModel(image::ScalarVolume(g, static_cast<float>(E_kPa)), poisson, defaults::liverDensity, false);
}

SupportSpec fixed(const Region& region) {
  SupportSpec s;
  s.region = region;
  return s;
}

SupportSpec spring(const std::string& surface, double kPa_per_mm) {
  SupportSpec s;
  s.kind = SupportSpec::Kind::Spring;
  s.region = SurfaceRegion{surface};
  s.stiffness_kPa_per_mm = kPa_per_mm;
  return s;
}

TEST(Model, MassAndVolumeOfABox) {
  const Model m = box({10, 10, 10}, {2, 3, 4}, 6.0, 0.45);
  EXPECT_NEAR(m.volume_mL, 24.0, 1e-12);
  EXPECT_NEAR(m.mass_kg, 24e-6 * 1060.0, 1e-15);
}

TEST(Model, NamesTheVoxelOfABadModulus) {
  image::Grid g;
  g.size = {4, 4, 4};
  image::ScalarVolume E(g, 5.0f);
  E.at(1, 2, 3) = -1.0f;
  EXPECT_THAT(messageOf([&] { makeModel(E, 0.45, defaults::liverDensity, false); }), HasSubstr("(1, 2, 3) in slice 3"));
  E.at(1, 2, 3) = std::nanf("");
  EXPECT_THROW(makeModel(E, 0.45, defaults::liverDensity, false), BadInput);
}

TEST(Model, RefusesALiverOfTheWrongSize) {
  image::Grid g;
  g.size = {4, 4, 4};
  EXPECT_THAT(messageOf([&] { makeModel(image::ScalarVolume(g, 5.0f), 0.45, defaults::liverDensity, true); }),
              HasSubstr("30 and 600 mm"));
}

TEST(Simulate, PatchOfUniaxialTractionIsExactOnAnyGridOrientation) {
  // A bar pulled along one patient axis, held so that it may contract: strain = t / E whatever the grid's axes.
  for (const int flip : {0, 1, 2, 3, 4}) {
    Eigen::Matrix3d d = Eigen::Matrix3d::Identity();
    if (flip == 1) d << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    if (flip == 2) d = Eigen::Vector3d(-1, -1, 1).asDiagonal();
    Model m = box({6, 5, 4}, {2, 3, 2.5}, 10.0, 0.3, d);
    const Vector3d corner = m.youngs_kPa.grid.indexToLps(Vector3d::Constant(-0.5));
    const Vector3d far = m.youngs_kPa.grid.indexToLps(m.youngs_kPa.grid.size.cast<double>() - Vector3d::Constant(0.5));
    const Vector3d low = corner.cwiseMin(far), high = corner.cwiseMax(far);
    retraction::Setup s;
    s.poisson = 0.3;
    if (flip == 3) s.model.kind = ModelKind::FemTet;
    if (flip == 4) s.model.kind = ModelKind::FemTet, s.model.quadraticTets = true;
    for (int a = 0; a < 3; ++a) {
      SupportSpec hold = fixed(FaceRegion{std::string(1, static_cast<char>('x' + a)) + "-"});
      hold.axes = {a == 0, a == 1, a == 2};
      s.supports.push_back(hold);
    }
    s.loads.push_back(Traction{FaceRegion{"x+"}, {0.5, 0, 0}});
    const Result r = simulate(m, s, {high, low});
    const Vector3d size = high - low;
    ASSERT_TRUE(r.solver.converged());
    EXPECT_NEAR(r.probe_u_mm[0].x(), 0.05 * size.x(), 1e-6 * size.x());
    EXPECT_NEAR(r.probe_u_mm[0].y(), -0.3 * 0.05 * size.y(), 1e-6 * size.y());
    EXPECT_NEAR(r.probe_u_mm[0].z(), -0.3 * 0.05 * size.z(), 1e-6 * size.z());
    EXPECT_NEAR(r.probe_u_mm[1].norm(), 0.0, 1e-9);
    EXPECT_NEAR(r.max_strain, 0.05, 1e-6);
    const double force_N = 0.5e3 * size.y() * size.z() * 1e-6;
    EXPECT_NEAR(r.load_N.x(), force_N, 1e-9 * force_N);
    EXPECT_NEAR((r.load_N + r.reaction_N).norm(), 0.0, 1e-6 * force_N);
    EXPECT_NEAR(r.energy_J, 0.5 * force_N * 0.05 * size.x() * 1e-3, 1e-6 * r.energy_J);
  }
}

TEST(Simulate, WinklerFoundationAloneSettlesAtPressureOverStiffness) {
  // A stiff slab on isotropic springs under its face: u = p / k, kPa over kPa/mm.
  const Model m = box({8, 8, 2}, {5, 5, 5}, 1e6, 0.3);
  retraction::Setup s;
  s.poisson = 0.3;
  s.supports.push_back(spring("inferior", 0.2));
  s.loads.push_back(Traction{FaceRegion{"z+"}, {0, 0, -1.0}});
  const Result r = simulate(m, s, {{20, 20, 5}});
  ASSERT_TRUE(r.solver.converged());
  EXPECT_NEAR(r.probe_u_mm[0].z(), -5.0, 0.01);
  EXPECT_NEAR(r.probe_u_mm[0].x(), 0.0, 1e-6);
}

TEST(Simulate, PressureInACavityBalances) {
  image::Grid g;
  g.size = {9, 9, 9};
  g.spacing_mm.setConstant(5);
  image::ScalarVolume E(g, 6.0f);
  for (int k = 3; k < 6; ++k)
    for (int j = 3; j < 6; ++j)
      for (int i = 3; i < 6; ++i) E.at(i, j, k) = 0.0f;
  const Model m = makeModel(E, 0.45, defaults::liverDensity, false);
  retraction::Setup s;
  s.supports.push_back(fixed(FaceRegion{"z-"}));
  s.loads.push_back(Pressure{SurfaceRegion{"inner"}, 0.1});
  const Result r = simulate(m, s, {{20, 20, 30}, {20, 20, 10}});
  EXPECT_NEAR(r.load_N.norm(), 0.0, 1e-12);
  EXPECT_GT(r.probe_u_mm[0].z(), 0.0) << "the roof of the cavity is pushed up";
  const Model solid = box({4, 4, 4}, {5, 5, 5}, 6, 0.45);
  EXPECT_THAT(messageOf([&] { simulate(solid, s, {}); }), HasSubstr("no enclosed cavity"));
}

TEST(Simulate, UnsupportedBodyIsRefusedWithTheNumberOfFreeModes) {
  const Model m = box({4, 4, 4}, {5, 5, 5}, 6, 0.45);
  retraction::Setup s;
  s.loads.push_back(BodyForce{{0, 0, -10}});
  EXPECT_THAT(messageOf([&] { simulate(m, s, {}); }), HasSubstr("6"));
  s.analysis.dynamic = true;
  s.analysis.end_s = 0.01;
  s.analysis.stopWhenSteady = 0;
  EXPECT_NO_THROW(simulate(m, s, {})) << "a free body may fall";
}

TEST(Contact, TotalForceIsKeptAndPointsAlongTheHoist) {
  const Model m = box({20, 20, 10}, {5, 5, 5}, 6, 0.45);
  for (const double spread : {0.0, 15.0}) {
    retraction::Setup s;
    s.supports.push_back(spring("all", 0.2));
    Retractor bar;
    bar.at_mm = Vector3d(50, 100, 25);  // posterior surface
    bar.spread_mm = spread;
    s.loads.push_back(bar);
    const Result r = simulate(m, s, {});
    const double weight_N = m.mass_kg * 9.81;
    EXPECT_NEAR(r.load_N.y(), -weight_N, 1e-9 * weight_N);
    EXPECT_NEAR(r.load_N.x(), 0.0, 1e-9);
    ASSERT_TRUE(r.retractorPoint_mm.has_value());
    EXPECT_NEAR(r.retractorPoint_mm->y(), 100.0, 1e-9);
    EXPECT_NEAR((r.load_N + r.reaction_N).norm(), 0.0, 1e-6 * weight_N);
  }
}

TEST(Contact, OffTheSurfaceIsNoContact) {
  const Model m = box({10, 10, 10}, {5, 5, 5}, 6, 0.45);
  retraction::Setup s;
  s.supports.push_back(fixed(FaceRegion{"z-"}));
  Retractor bar;
  bar.at_mm = Vector3d(25, 200, 25);
  s.loads.push_back(bar);
  EXPECT_THAT(messageOf([&] { simulate(m, s, {}); }), HasSubstr("no contact"));
}

TEST(Regions, FaceIsTheBoundingPlaneAndSurfaceIsEveryFaceThatLooksThere) {
  // A staircase: two columns of different height.
  image::Grid g;
  g.size = {2, 1, 2};
  image::ScalarVolume E(g, 6.0f);
  E.at(1, 0, 1) = 0.0f;
  const Body body(makeModel(E, 0.45, defaults::liverDensity, false));
  EXPECT_EQ(body.faces(FaceRegion{"z+"}).size(), 1u);
  EXPECT_EQ(body.faces(SurfaceRegion{"superior"}).size(), 2u);
  EXPECT_EQ(body.nodes(FaceRegion{"z-"}).size(), 6u);
  EXPECT_EQ(body.nodes(BoxRegion{{-0.5, -0.5, -0.5}, {0.5, 0.5, 1.5}}).size(), 12u);
  EXPECT_THAT(messageOf([&] { body.nodes(BoxRegion{{50, 50, 50}, {60, 60, 60}}); }), HasSubstr("box_mm"));
}

TEST(Regions, FacesFollowThePatientNotTheGrid) {
  Eigen::Matrix3d d;
  d << -1, 0, 0, 0, -1, 0, 0, 0, 1;  // a RAS file: the grid's x runs to the patient's right
  const Body body(box({3, 4, 5}, {2, 2, 2}, 6, 0.45, d));
  EXPECT_EQ(body.faces(FaceRegion{"x-"}).size(), 4u * 5u);
  EXPECT_EQ(body.faces(SurfaceRegion{"posterior"}).size(), 3u * 5u);
  for (const SurfaceFace* f : body.faces(FaceRegion{"x-"})) EXPECT_NEAR(f->centre_mm.x(), -6.0, 1e-9);
  for (const SurfaceFace* f : body.faces(SurfaceRegion{"posterior"})) EXPECT_NEAR(f->normal.y(), 1.0, 1e-12);
}

TEST(Condensed, AnswersAsTheFullSolveStaticAndInTime) {
  const Model m = box({8, 5, 5}, {5, 5, 5}, 6, 0.45);
  retraction::Setup s;
  s.supports.push_back(fixed(FaceRegion{"x-"}));
  s.supports.push_back(spring("inferior", 0.05));
  s.loads.push_back(BodyForce{{0, 0, -3000}});
  s.loads.push_back(Traction{FaceRegion{"x+"}, {0.02, 0, 0.05}});
  s.solver.tolerance = 1e-11;
  const Result full = simulate(m, s, {{40, 12, 12}});
  s.condensed = true;
  const Result condensed = simulate(m, s, {{40, 12, 12}});
  EXPECT_LT((full.nodal_u_m - condensed.nodal_u_m).cwiseAbs().maxCoeff(), 1e-9) << "1e-6 mm";
  EXPECT_NEAR((condensed.load_N + condensed.reaction_N).norm(), 0.0, 1e-7 * condensed.load_N.norm());
  EXPECT_NEAR(full.energy_J, condensed.energy_J, 1e-8 * full.energy_J);
  s.analysis.dynamic = true;
  s.analysis.h_ms = 5;
  s.analysis.end_s = 20;
  s.analysis.rayleigh = {5, 0.02};
  s.analysis.stopWhenSteady = 1e-10;
  const Result settled = simulate(m, s, {{40, 12, 12}});
  EXPECT_GT(settled.steps, 10);
  EXPECT_LT((full.nodal_u_m - settled.nodal_u_m).cwiseAbs().maxCoeff(), 1e-6 * full.nodal_u_m.cwiseAbs().maxCoeff());
  s.model.kind = ModelKind::Meshfree;
  EXPECT_THAT(messageOf([&] { simulate(m, s, {}); }), HasSubstr("fem-hex"));
}

TEST(Scaled, IsTheAnswerOfTheOtherStiffness) {
  const Model stiff = box({6, 4, 4}, {5, 5, 5}, 12, 0.45), soft = box({6, 4, 4}, {5, 5, 5}, 6, 0.45);
  retraction::Setup s;
  s.supports.push_back(fixed(FaceRegion{"x-"}));
  s.loads.push_back(BodyForce{{0, 0, -2000}});
  const Result a = simulate(stiff, s, {}), b = simulate(soft, s, {}), scaledAnswer = scaled(soft, s, {}, a, 2.0);
  EXPECT_LT((b.nodal_u_m - scaledAnswer.nodal_u_m).norm(), 1e-7 * b.nodal_u_m.norm());
  EXPECT_NEAR(b.energy_J, scaledAnswer.energy_J, 1e-7 * b.energy_J);
  const comparison::Difference d = comparison::compare(soft, b, scaledAnswer, {});
  EXPECT_LT(d.max_mm, 1e-6 * b.max_displacement_mm);
  const comparison::Difference half = comparison::compare(soft, b, a, {{15, 10, 10}});
  EXPECT_NEAR(half.max_mm, 0.5 * b.max_displacement_mm, 0.2 * b.max_displacement_mm);
  ASSERT_EQ(half.vessel_mm.size(), 1u);
  EXPECT_GT(half.vessel_mm[0], 0.0);
}

}  // namespace
}  // namespace glisson::retraction
