// SPDX-License-Identifier: GPL-3.0-or-later

// Tetrahedra that follow the organ's smooth surface, against closed forms and against voxels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "retraction/simulate.h"

namespace glisson::retraction {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

image::Grid around(const Vector3d& centre, double half_mm, const Vector3d& h_mm, const Eigen::Matrix3d& direction) {
  image::Grid g;
  g.spacing_mm = h_mm;
  g.direction = direction;
  for (int a = 0; a < 3; ++a) g.size[a] = static_cast<int>(std::ceil(2 * half_mm / h_mm[a]));
  g.origin_lps_mm = centre - direction * h_mm.cwiseProduct(0.5 * (g.size.cast<double>().array() - 1.0).matrix());
  return g;
}

template <class Modulus>
Model bodyOf(const image::Grid& g, double poisson, Modulus&& E_kPa) {
  image::ScalarVolume E(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) E.at(i, j, k) = static_cast<float>(E_kPa(g.indexToLps(Vector3d(i, j, k))));
  return makeModel(std::move(E), poisson, defaults::liverDensity, false);
}

Eigen::Matrix3d tilted() {
  return Eigen::AngleAxisd(0.4, Vector3d(1, 2, -1).normalized()).toRotationMatrix() *
         Eigen::Matrix3d(Vector3d(1, 1, -1).asDiagonal());
}

// A body of any shape under pressure all round shrinks evenly: strain −p (1 − 2ν) / E, whatever its outline. Forces
// that are carried over to the nearest points of the mesh move by half a voxel diagonal at most, here a twentieth of
// the radius, and by nothing in the mean: 3 % are allowed. Pairs of probes leave rigid motion out.
TEST(Delaunay, PressureAllRoundShrinksEvenly) {
  const Vector3d centre(30, -20, 400), semi(44, 38, 36);
  const double E = 3, nu = 0.4, p = 0.1;
  const Model m = bodyOf(around(centre, 48, {2, 2, 2.5}, tilted()), nu,
                         [&](const Vector3d& x) { return (x - centre).cwiseQuotient(semi).norm() < 1 ? E : 0.0; });
  retraction::Setup s;
  s.poisson = nu;
  s.loads = {Pressure{SurfaceRegion{"outer"}, p}};
  SupportSpec soft;  // keeps it in place; takes 1e-4 of the pressure
  soft.kind = SupportSpec::Kind::Spring;
  soft.region = SurfaceRegion{"outer"};
  soft.stiffness_kPa_per_mm = 1e-4;
  s.supports = {soft};
  s.model.kind = ModelKind::FemTet;
  s.model.delaunay = s.model.quadraticTets = true;
  s.model.cell_mm = 12.0;
  std::vector<Vector3d> probes;
  const std::vector<Vector3d> ways = {{20, 0, 0}, {0, 18, 0}, {0, 0, 16}, {-10, 10, 10}};
  for (const Vector3d& d : ways) {
    probes.push_back(centre + d);
    probes.push_back(centre - d);
  }
  const Result r = simulate(m, s, probes);
  ASSERT_TRUE(r.solver.converged());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double strain = (r.probe_u_mm[2 * i] - r.probe_u_mm[2 * i + 1]).dot(ways[i]) / (2.0 * ways[i].squaredNorm());
    std::printf("  strain %.5f (%.5f)\n", strain, -p * (1 - 2 * nu) / E);
    EXPECT_NEAR(strain / (-p * (1 - 2 * nu) / E), 1.0, 0.03);
  }
  EXPECT_THAT(r.notes.front(), HasSubstr("quadratic Delaunay tetrahedra"));
}

// An ellipsoid hoisted by a bar: quadratic tetrahedra against voxels. Force and reaction keep their sums.
TEST(Delaunay, RetractionAgreesWithVoxels) {
  const Vector3d centre(0, 0, 100), semi(60, 45, 40);
  for (const Eigen::Matrix3d& d : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), tilted()}) {
    const Model m = bodyOf(around(centre, 64, {3, 3, 4}, d), 0.45, [&](const Vector3d& x) {
      return (x - centre).cwiseQuotient(semi).norm() < 1 ? (x.x() > 0 ? 9.0 : 6.0) : 0.0;
    });
    retraction::Setup s;
    SupportSpec bed;
    bed.kind = SupportSpec::Kind::Spring;
    bed.region = SurfaceRegion{"outer"};
    bed.stiffness_kPa_per_mm = 0.2;
    s.supports = {bed};
    Retractor bar;
    bar.at_mm = centre + Vector3d(0, 45, 0);
    bar.length_mm = 50;
    bar.force_N = 0.6;
    s.loads = {bar, BodyForce{{0, 0, -200}}};
    const std::vector<Vector3d> probes = {centre, centre + Vector3d(30, 10, 5), centre + Vector3d(-30, -10, 10),
                                          centre + Vector3d(0, 25, 0), centre + Vector3d(10, 0, -25)};
    const Result voxels = simulate(m, s, probes);
    s.model.kind = ModelKind::FemTet;
    s.model.delaunay = s.model.quadraticTets = true;
    s.model.cell_mm = 16.0;
    s.model.toolCell_mm = 8.0;
    const Result tets = simulate(m, s, probes);
    ASSERT_TRUE(voxels.solver.converged());
    ASSERT_TRUE(tets.solver.converged());
    EXPECT_LT((tets.load_N - voxels.load_N).norm(), 1e-9);
    EXPECT_LT((tets.reaction_N + tets.load_N).norm(), 1e-6);
    EXPECT_NEAR(tets.energy_J / voxels.energy_J, 1.0, 0.1);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      std::printf("  probe %zu: %.3f %.3f %.3f against %.3f %.3f %.3f mm\n", i, tets.probe_u_mm[i].x(),
                  tets.probe_u_mm[i].y(), tets.probe_u_mm[i].z(), voxels.probe_u_mm[i].x(), voxels.probe_u_mm[i].y(),
                  voxels.probe_u_mm[i].z());
      EXPECT_LT((tets.probe_u_mm[i] - voxels.probe_u_mm[i]).norm(), 0.05 * voxels.max_displacement_mm);
    }
  }
}

TEST(Delaunay, ARetractorNearTheSurfaceIsLaidOntoIt) {
  const Vector3d centre(0, 0, 100);
  const Model m = bodyOf(around(centre, 44, {3, 3, 3}, Eigen::Matrix3d::Identity()), 0.45,
                         [&](const Vector3d& x) { return (x - centre).norm() < 40 ? 6.0 : 0.0; });
  retraction::Setup s;
  SupportSpec bed;
  bed.kind = SupportSpec::Kind::Spring;
  bed.region = SurfaceRegion{"outer"};
  bed.stiffness_kPa_per_mm = 0.2;
  s.supports = {bed};
  Retractor bar;
  bar.at_mm = centre + Vector3d(0, 47, 0);
  bar.length_mm = 30;
  bar.force_N = 0.1;
  s.loads = {bar};
  const Result r = simulate(m, s, {});
  EXPECT_THAT(r.notes, testing::Contains(HasSubstr("laid onto the surface")));
  EXPECT_LT((*r.retractorPoint_mm - centre).norm(), 42.0);  // the middle of a curved patch lies below its surface
  EXPECT_GT((*r.retractorPoint_mm - centre).norm(), 30.0);
  std::get<Retractor>(s.loads[0]).at_mm = centre + Vector3d(0, 60, 0);
  try {
    simulate(m, s, {});
    FAIL();
  } catch (const BadInput& e) {
    EXPECT_THAT(e.what(), HasSubstr("no contact"));
  }
}

}  // namespace
}  // namespace glisson::retraction
