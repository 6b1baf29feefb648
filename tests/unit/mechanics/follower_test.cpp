// SPDX-License-Identifier: GPL-3.0-or-later

// Loads that follow their faces, beds that only press, and tethers.
#include "mechanics/contact/follower_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "mechanics/contact/contact_setup.h"

namespace glisson::mechanics {
namespace {

VoxelBody box(const Eigen::Vector3i& cells, double h_m, double E_Pa, double poisson) {
  VoxelBody b;
  b.cells = cells;
  b.h_m.setConstant(h_m);
  b.E_Pa.assign(static_cast<std::size_t>(cells.prod()), E_Pa);
  b.poisson = poisson;
  return b;
}

ContactProblem held(const VoxelBody& body, const std::function<std::array<bool, 3>(const Eigen::Vector3i&)>& axes) {
  ContactProblem p;
  p.problem.body = body;
  const VoxelMesh mesh(body);
  p.problem.f_N = NodalField::Zero(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const std::array<bool, 3> held = axes(mesh.latticeOf(n));
    if (held[0] || held[1] || held[2]) p.problem.supports.fixations.push_back({n, held, {0, 0, 0}});
  }
  return p;
}

/// The faces of a box that look along an axis, at its upper side, under a load.
std::vector<FollowerFace> facesOf(const VoxelBody& b, int axis, double pressure_Pa,
                                  const Eigen::Vector3d& shear_Pa = {0, 0, 0}) {
  std::vector<FollowerFace> faces;
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  for (int j = 0; j < b.cells[second]; ++j)
    for (int i = 0; i < b.cells[first]; ++i) {
      FollowerFace f;
      for (std::size_t c = 0; c < 4; ++c) {
        Eigen::Vector3d at;
        at[axis] = b.cells[axis];
        at[first] = i + (c == 1 || c == 2 ? 1 : 0);
        at[second] = j + (c >= 2 ? 1 : 0);
        f.corner_m[c] = at.cwiseProduct(b.h_m);
      }
      f.pressure_Pa = pressure_Pa;
      f.shear_Pa = shear_Pa;
      faces.push_back(f);
    }
  return faces;
}

Eigen::Vector3d tip_mm(const ContactProblem& p, const ContactSolution& s) {
  const Eigen::Vector3i& n = p.problem.body.cells;
  return 1e3 * s.solution.u_m.col(VoxelMesh(p.problem.body).nodeAt(n.x(), n.y() / 2, n.z() / 2));
}

const auto clampedEnd = [](const Eigen::Vector3i& at) {
  return std::array<bool, 3>{at.x() == 0, at.x() == 0, at.x() == 0};
};

TEST(FollowerLoads, AreTheDerivativesOfWhatTheySay) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> range(-1, 1);
  const auto point = [&] { return Eigen::Vector3d(range(random), range(random), range(random)); };
  for (int i = 0; i < 20; ++i) {
    FollowerTriangle t{{point(), point(), point()}, range(random), range(random), {range(random), range(random)}};
    const auto K = t.stiffness_N_m();
    const double step = 1e-6;
    for (std::size_t j = 0; j < 3; ++j)
      for (int c = 0; c < 3; ++c) {
        FollowerTriangle up = t, down = t;
        up.x_m[j][c] += step;
        down.x_m[j][c] -= step;
        EXPECT_LT(((up.force_N() - down.force_N()) / (2 * step) - K[j].col(c)).norm(), 1e-6 * (1 + K[j].norm()));
      }
  }
}

TEST(FollowerLoads, HaveAPotentialWhereTheirRimMovesInPlanesOnly) {
  const VoxelBody b = box({4, 3, 5}, 2e-3, 5e3, 0.3);
  const auto potential = [&](const std::function<std::array<bool, 3>(const Eigen::Vector3i&)>& axes) {
    const ContactProblem p = held(b, axes);
    return potentialOf(VoxelMesh(b), facesOf(b, 1, 100), p.problem.supports.fixations);
  };
  EXPECT_FALSE(potential(clampedEnd));
  EXPECT_FALSE(potential([](const Eigen::Vector3i& at) {
    return std::array<bool, 3>{at.x() == 0, false, at.z() == 0};
  }));
  // All four sides slide along planes: those across x and z are parallel in pairs, and volume is counted along y alone.
  const auto sliding = potential([](const Eigen::Vector3i& at) {
    return std::array<bool, 3>{at.x() == 0 || at.x() == 4, false, at.z() == 0 || at.z() == 5};
  });
  ASSERT_TRUE(sliding);
  EXPECT_EQ(sliding->weight, Eigen::Vector3d(0, 1, 0));
  EXPECT_TRUE(potential([](const Eigen::Vector3i& at) {
    return std::array<bool, 3>{at.y() == 3, at.y() == 3, at.y() == 3};
  }));
  // Two pressures side by side have a rim between them.
  std::vector<FollowerFace> two = facesOf(b, 1, 100);
  for (std::size_t i = 0; i < two.size() / 2; ++i) two[i].pressure_Pa = 50;
  const ContactProblem p = held(b, [](const Eigen::Vector3i& at) {
    return std::array<bool, 3>{at.x() == 0 || at.x() == 4, false, at.z() == 0 || at.z() == 5};
  });
  EXPECT_FALSE(potentialOf(VoxelMesh(b), two, p.problem.supports.fixations));
}

TEST(FollowerLoads, ThePotentialFallsAsTheForcesWork) {
  // A box that slides along two walls, pressed on its top: work of the unbalanced forces against the potential.
  ContactProblem p = held(box({4, 3, 4}, 2e-3, 5e3, 0.3), [](const Eigen::Vector3i& at) {
    return std::array<bool, 3>{at.x() == 0 || at.x() == 4, at.y() == 0, at.z() == 0 || at.z() == 4};
  });
  p.pressures = facesOf(p.problem.body, 1, 2e3);
  SolidHierarchy hierarchy(finestLevel(p));
  std::vector<std::size_t> kept;
  ContactEnergy energy(hierarchy, carriedSurface(hierarchy, p, kept), p, {});
  ASSERT_TRUE(energy.hasPotential());
  energy.setLoads(0, loadsOnLevels(hierarchy, p)[0]);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> range(-3e-4, 3e-4);
  const SolidLevel& level = hierarchy.level(0);
  ContactEnergy::State state, up, down;
  state.u.assign(3 * level.nodes(), 0.0);
  std::vector<double> way(state.u.size(), 0.0);
  for (std::size_t i = 0; i < way.size(); ++i)
    if (level.active[i] > 0) state.u[i] = range(random), way[i] = range(random);
  up = down = state;
  for (std::size_t i = 0; i < way.size(); ++i) up.u[i] += 1e-3 * way[i], down.u[i] -= 1e-3 * way[i];
  ContactEnergy::Value value, high, low;
  ASSERT_TRUE(energy.evaluate(state, {}, false, value) && energy.evaluate(up, {}, false, high) &&
              energy.evaluate(down, {}, false, low));
  double work = 0;
  for (std::size_t i = 0; i < way.size(); ++i) work += value.gradient[i] * way[i];
  EXPECT_NEAR((high.potential - low.potential) / 2e-3, work, 1e-5 * std::abs(work));
}

TEST(FollowerLoads, OpenFacesConvergeUnderLargePressures) {
  const auto balanced = [](const ContactProblem& p, double size_N) {
    const ContactSolution s = solveContact(p);
    ASSERT_TRUE(s.solution.report.converged()) << p.pressures[0].pressure_Pa << " Pa: " << s.solution.report.residual;
    const Eigen::Vector3d sum = s.following_N + s.solution.reaction_N.rowwise().sum();
    EXPECT_LT(sum.norm(), 1e-5 * size_N);
  };
  // A block on its clamped base, pressed on one side: p/E to .7.
  for (const double p_Pa : {600.0, 2000.0, 4200.0}) {
    ContactProblem p = held(box({16, 6, 10}, 10e-3, 6e3, 0.45), [](const Eigen::Vector3i& at) {
      return std::array<bool, 3>{at.y() == 0, at.y() == 0, at.y() == 0};
    });
    p.pressures = facesOf(p.problem.body, 0, p_Pa);
    balanced(p, p_Pa * 6e-3);
  }
  // A strip of 60 × 6 × 6 mm that curls: pressure times length³ over bending stiffness 12 to 36.
  for (const double p_Pa : {20.0, 40.0, 60.0}) {
    ContactProblem p = held(box({30, 3, 3}, 2e-3, 20e3, 0.3), clampedEnd);
    p.pressures = facesOf(p.problem.body, 2, p_Pa);
    balanced(p, p_Pa * 36e-5);
  }
}

TEST(FollowerLoads, ATractionAlongTheNormalIsAPressureAndAShearTurnsWithTheFace) {
  ContactProblem p = held(box({20, 2, 2}, 2e-3, 20e3, 0.3), clampedEnd);
  p.pressures = facesOf(p.problem.body, 0, -500);
  const ContactSolution pulled = solveContact(p);
  ASSERT_TRUE(pulled.solution.report.converged());
  // Per deformed area: the end is thinner than at rest, the force smaller than what it would be there.
  const double rest_N = 500 * 16e-6;
  EXPECT_LT(pulled.following_N.x(), rest_N);
  EXPECT_NEAR(pulled.following_N.x(), rest_N, 0.05 * rest_N);
  // A cantilever whose end is sheared bends further round than under a dead force, which keeps its direction.
  p.pressures = facesOf(p.problem.body, 0, 0, {0, 0, -30});
  const ContactSolution follows = solveContact(p);
  ASSERT_TRUE(follows.solution.report.converged());
  p.pressures.clear();
  const VoxelMesh mesh(p.problem.body);
  for (int j = 0; j <= 2; ++j)
    for (int k = 0; k <= 2; ++k)
      p.problem.f_N(2, mesh.nodeAt(20, j, k)) = -30 * 4e-6 * (j == 1 ? 1 : 0.5) * (k == 1 ? 1 : 0.5);
  const ContactSolution dead = solveContact(p);
  ASSERT_TRUE(dead.solution.report.converged());
  EXPECT_LT(tip_mm(p, dead).z(), -10);
  EXPECT_LT(tip_mm(p, follows).x(), tip_mm(p, dead).x());
  EXPECT_NEAR(follows.following_N.norm(), 30 * 16e-6, 0.03 * 30 * 16e-6);
  EXPECT_LT(follows.following_N.x(), -0.3 * follows.following_N.norm());
}

TEST(Holding, ATetherPullsAlongItsFibreAndGoesSlack) {
  // A stiff cube on soft springs hangs on one fibre: pulled away it is held by it, pushed towards it not.
  ContactProblem p = held(box({2, 2, 2}, 5e-3, 1e6, 0.3), [](const Eigen::Vector3i&) { return std::array<bool, 3>{}; });
  const VoxelMesh mesh(p.problem.body);
  for (int n = 0; n < mesh.nodeCount(); ++n) p.problem.supports.springs.push_back({n, Eigen::Matrix3d::Identity()});
  Tether t;
  t.p_m = {5e-3, 10e-3, 5e-3};
  t.anchor_m = {5e-3, 40e-3, 5e-3};
  t.length_m = 30e-3;
  t.k_N_m = 100;
  p.tethers = {t};
  const double springs_N_m = mesh.nodeCount(), force_N = 0.2;
  const auto moved = [&](double sign, ContactSolution& s) {
    p.problem.f_N.setZero();
    p.problem.f_N.row(1).setConstant(sign * force_N / mesh.nodeCount());
    s = solveContact(p);
    EXPECT_TRUE(s.solution.report.converged());
    return s.solution.u_m.row(1).mean();
  };
  ContactSolution s;
  EXPECT_NEAR(moved(1, s), force_N / springs_N_m, 1e-5);
  EXPECT_EQ(s.tether_N[0].norm(), 0);
  EXPECT_NEAR(moved(-1, s), -force_N / (springs_N_m + t.k_N_m), 1e-4);
  EXPECT_NEAR(s.tether_N[0].y(), -100 * s.solution.u_m(1, mesh.nodeAt(1, 2, 1)), 1e-4);
  EXPECT_NEAR(s.solution.reaction_N.row(1).sum(), force_N, 1e-6);
  // With slack it pulls later, and two-sided it pushes.
  p.tethers[0].length_m = 31e-3;
  EXPECT_NEAR(moved(-1, s), -(force_N + 0.1) / (springs_N_m + t.k_N_m), 1e-4);
  p.tethers[0] = t;
  p.tethers[0].twoSided = true;
  EXPECT_NEAR(moved(1, s), force_N / (springs_N_m + t.k_N_m), 1e-4);
}

TEST(Holding, ABedHoldsAlongItsFaceByItsShare) {
  ContactProblem p = held(box({4, 2, 4}, 5e-3, 1e6, 0.3), [](const Eigen::Vector3i&) { return std::array<bool, 3>{}; });
  const VoxelMesh mesh(p.problem.body);
  for (int k = 0; k <= 4; ++k)
    for (int i = 0; i <= 4; ++i) p.bed.push_back({mesh.position_m(mesh.nodeAt(i, 0, k)), {0, -1, 0}, 40, 4});
  p.problem.f_N.row(0).setConstant(0.1 / mesh.nodeCount());
  p.problem.f_N.row(1).setConstant(-0.5 / mesh.nodeCount());
  const ContactSolution s = solveContact(p);
  ASSERT_TRUE(s.solution.report.converged());
  double sideways = 0;
  for (const BedSample& b : p.bed) {
    const Eigen::Vector3i at = (b.p_m / 5e-3).array().round().cast<int>();
    sideways += s.solution.u_m(0, mesh.nodeAt(at.x(), at.y(), at.z())) / static_cast<double>(p.bed.size());
  }
  EXPECT_NEAR(sideways, 0.1 / (4 * 25), 1e-5);
  EXPECT_NEAR(s.solution.reaction_N.row(0).sum(), -0.1, 1e-6);
  EXPECT_NEAR(s.solution.reaction_N.row(1).sum(), 0.5, 1e-6);
}

}  // namespace
}  // namespace glisson::mechanics
