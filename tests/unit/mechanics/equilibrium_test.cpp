// SPDX-License-Identifier: GPL-3.0-or-later

// What small changes of a contact problem do to its answer: the exact tangent against full solves.
#include "mechanics/contact/equilibrium.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <random>

#include "base/error.h"
#include "base/parallel.h"
#include "contact_scenes.h"
#include "mechanics/contact/contact_setup.h"

namespace glisson::mechanics {
namespace {

/// A block on springs with a stiff rind, pressed by a bar that lies askew.
ContactProblem sprung(SolidLaw law) {
  ContactProblem p = onClampedBlock(box({16, 8, 12}, Eigen::Vector3d::Constant(5e-3), 6000, 0.42), 4);
  p.law = law;
  const VoxelMesh mesh(p.problem.body);
  for (std::size_t c = 0; c < p.problem.body.E_Pa.size(); ++c)
    p.problem.body.E_Pa[c] *= 1 + 0.3 * std::sin(0.7 * static_cast<double>(c));
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).x() == 0) p.problem.supports.springs.push_back({n, 3.0 * Eigen::Matrix3d::Identity()});
  p.rind_Pa = rindOf(p.problem.body, p.surface, 80.0, 3e-3);
  const Eigen::Vector3d along = Eigen::Vector3d(1, 0, 0.3).normalized();
  const Eigen::Vector3d centre(0.042, 0.06, 0.031);
  p.bar = RigidBar{{centre - 0.025 * along, centre + 0.025 * along}, 0.005, {0, -1, 0}};
  p.force_N = 1.2;
  return p;
}

Change namedChange(const std::string& name, const ContactProblem& p, const RigidBar& bar) {
  Change c;
  c.pivot_m = bar.centre_m();
  if (name == "moduli") {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0.0, 1.0);
    c.logModuli.resize(p.problem.body.E_Pa.size());
    for (double& v : c.logModuli) v = normal(random);
  }
  if (name == "stiffness") c.logModuli.assign(p.problem.body.E_Pa.size(), 1.0);
  if (name == "poisson, shear") c.poisson = 0.3;
  if (name == "poisson, Young's") c.poisson = 0.3, c.shearKept = false;
  if (name == "supports") c.logSupports = 1;
  if (name == "skin") c.logSkin = 1;
  if (name == "force") c.force_N = 1.2;
  if (name == "along") c.barShift_m = {5e-3, 0, 0};
  if (name == "across") c.barShift_m = {0, 0, 5e-3};
  if (name == "turn") c.barTurn_rad = {0.02, 0.1, 0.05};
  if (name == "surface") c.outward_m = 5e-3, c.growth_Pa_m = std::vector<double>(p.problem.body.E_Pa.size(), 1e4);
  return c;
}

Change scaled(Change c, double by) {
  for (double& v : c.logModuli) v *= by;
  c.poisson *= by, c.logSupports *= by, c.logSkin *= by, c.force_N *= by, c.outward_m *= by;
  c.barShift_m *= by;
  c.barTurn_rad *= by;
  return c;
}

const std::vector<std::string> names = {"moduli",   "stiffness", "poisson, shear", "poisson, Young's",
                                        "supports", "skin",      "force",          "along",
                                        "across",   "turn",      "surface"};

class AtEquilibrium : public testing::TestWithParam<SolidLaw> {};

TEST_P(AtEquilibrium, TheTangentSaysWhatFullSolvesOfChangedProblemsSay) {
  const ContactProblem p = sprung(GetParam());
  ContactOptions options;
  options.tolerance = 1e-8;
  const ContactSolution answer = solveContact(p, options);
  ASSERT_EQ(answer.outcome, ContactOutcome::Reached);
  Equilibrium at(p, options, answer.solution.u_m, answer.travel_m);
  ASSERT_TRUE(at.usable());
  EXPECT_LT(at.residual(), 1e-6);
  for (const std::string& name : names) {
    const Change change = namedChange(name, p, at.bar());
    // A bar whose end passes over samples of the surface has kinks some µm apart: 2.5 µm stay between two.
    const bool ofBar = name == "along" || name == "across" || name == "turn";
    const double step = ofBar ? 5e-4 : 4e-3;
    const EquilibriumMotion first = at.respond(at.by(change), 1e-6);
    ASSERT_TRUE(first.found) << name;
    const EquilibriumMotion up = at.afterwards(scaled(change, step), nullptr, 1e-8, {});
    const EquilibriumMotion down = at.afterwards(scaled(change, -step), nullptr, 1e-8, {});
    ASSERT_TRUE(up.found && down.found) << name;
    const NodalField full = (up.u_m - down.u_m) / (2 * step);
    EXPECT_GT(full.norm(), 1e-5) << name;
    EXPECT_LT((first.u_m - full).norm(), 2e-3 * full.norm()) << name;
    const double travel = (up.travel_m - down.travel_m) / (2 * step);
    EXPECT_NEAR(first.travel_m, travel, 2e-3 * std::abs(travel) + 1e-3 * full.colwise().norm().maxCoeff()) << name;
  }
}

TEST_P(AtEquilibrium, TheAdjointSaysOfAFigureWhatEveryTangentSaysAndWhatFullSolvesSay) {
  const ContactProblem p = sprung(GetParam());
  ContactOptions options;
  options.tolerance = 1e-9;
  const ContactSolution answer = solveContact(p, options);
  ASSERT_EQ(answer.outcome, ContactOutcome::Reached);
  Equilibrium at(p, options, answer.solution.u_m, answer.travel_m);
  ASSERT_TRUE(at.usable());
  MotionWeights figure;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  figure.node = NodalField::Zero(3, answer.solution.u_m.cols());
  for (double& w : figure.node.reshaped()) w = normal(random);
  figure.surface = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(p.surface.size()));
  for (std::size_t s = 0; s < p.surface.size(); ++s)
    if (answer.pressure_Pa[s] > 0) figure.surface(1, static_cast<Eigen::Index>(s)) = 5;
  figure.travel = 40;
  const std::optional<std::vector<double>> gradient = at.gradientByModuli(figure, 1e-9, 2000);
  ASSERT_TRUE(gradient);
  ASSERT_EQ(gradient->size(), p.problem.body.E_Pa.size());
  for (const char* name : {"moduli", "stiffness"}) {
    const Change change = namedChange(name, p, at.bar());
    double said = 0, size = 0;
    for (std::size_t c = 0; c < gradient->size(); ++c) {
      said += (*gradient)[c] * change.logModuli[c];
      size += std::abs((*gradient)[c] * change.logModuli[c]);
    }
    const EquilibriumMotion forward = at.respond(at.by(change), 1e-9, 2000);
    ASSERT_TRUE(forward.found) << name;
    EXPECT_NEAR(said, figure.of(forward), 1e-6 * size) << name;
    const double step = 2e-3;
    const EquilibriumMotion up = at.afterwards(scaled(change, step), nullptr, 1e-9, {});
    const EquilibriumMotion down = at.afterwards(scaled(change, -step), nullptr, 1e-9, {});
    ASSERT_TRUE(up.found && down.found) << name;
    EXPECT_NEAR(said, (figure.of(up) - figure.of(down)) / (2 * step), 1e-3 * size) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, AtEquilibrium,
                         testing::Values(SolidLaw::Polynomial, SolidLaw::Logarithmic, SolidLaw::Linear));

TEST(Equilibrium, ALinearBodyIsAsStiffAsItsModulus) {
  // Clamped, linear and without barrier effects the travel under a force goes as 1/E: d travel / d ln E =
  // −(indentation).
  ContactProblem p = sprung(SolidLaw::Linear);
  p.problem.supports.springs.clear();
  p.rind_Pa.clear();
  const ContactSolution answer = solveContact(p, {.tolerance = 1e-7});
  Equilibrium at(p, {.tolerance = 1e-7}, answer.solution.u_m, answer.travel_m);
  Change stiffer;
  stiffer.logModuli.assign(p.problem.body.E_Pa.size(), 1.0);
  const EquilibriumMotion m = at.respond(at.by(stiffer), 1e-6);
  ASSERT_TRUE(m.found);
  // Stiffness of everything by a factor is force by its inverse.
  Change force;
  force.force_N = -1.2;
  const EquilibriumMotion f = at.respond(at.by(force), 1e-6);
  ASSERT_TRUE(f.found);
  EXPECT_LT((m.u_m - f.u_m).norm(), 0.05 * f.u_m.norm());
  EXPECT_LT(m.travel_m, 0);
}

TEST(Equilibrium, AGivenTravelStaysAndTheNumberOfThreadsDoesNotChangeABit) {
  ContactProblem p = sprung(SolidLaw::Polynomial);
  p.force_N.reset();
  p.travel_m = 8e-3;
  const ContactSolution answer = solveContact(p);
  const auto respond = [&](int threads) {
    setThreadCount(threads);
    Equilibrium at(p, {}, answer.solution.u_m, answer.travel_m);
    return at.respond(at.by(namedChange("moduli", p, at.bar())));
  };
  const EquilibriumMotion one = respond(1), three = respond(3);
  setThreadCount(0);
  ASSERT_TRUE(one.found && three.found);
  EXPECT_EQ(one.travel_m, 0);
  EXPECT_GT(one.u_m.norm(), 0);
  EXPECT_EQ(std::memcmp(one.u_m.data(), three.u_m.data(), sizeof(double) * static_cast<std::size_t>(one.u_m.size())),
            0);
}

TEST(Equilibrium, ATurnedBarIsTheBarSeenFromTurnedAxes) {
  const RigidBar bar = hook({0.01, 0.02, 0.03}, {1, 0, 0}, {0, 0, 1}, 0.08, 1.2);
  const Eigen::Vector3d turn(0.1, -0.2, 0.15), pivot(0.3, 0.1, -0.2), shift(0.01, 0, -0.02), p(0.02, 0.03, 0.045);
  const RigidBar there = moved(bar, shift, turn, pivot);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  const Gap before = gapTo(bar, p, 0.004), after = gapTo(there, R * (p - pivot) + pivot + shift, 0.004);
  EXPECT_NEAR(before.g_m, after.g_m, 1e-12);
  EXPECT_LT((R * before.n - after.n).norm(), 1e-12);
  EXPECT_THROW(Equilibrium(sprung(SolidLaw::Linear), {}, NodalField::Zero(3, 5), 0.01), BadArgument);
}

}  // namespace
}  // namespace glisson::mechanics
