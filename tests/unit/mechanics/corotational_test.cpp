// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/corotational.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "base/random.h"
#include "mechanics/hyperelastic.h"

// Theorems of one element, for both kinds of large deformation.
namespace glisson::mechanics {
namespace {

constexpr double E = 12e3;
const Eigen::Vector3d h(2e-3, 3e-3, 2.5e-3);
using Evaluate = std::function<bool(const HexCorners&, Tangent, HexResponse&)>;

struct Case {
  std::string name;
  HexElement linear;  ///< what it is for small strain
  double poisson;
  Evaluate evaluate;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double nu : {0.0, 0.3, 0.49}) {
    for (const HexElement element : {HexElement::Incompatible, HexElement::BBar, HexElement::H8}) {
      const CorotationalHex hex(hexStiffness(element, nu, h), h);
      all.push_back({"corotational", element, nu,
                     [hex](const HexCorners& u, Tangent t, HexResponse& r) { return hex.evaluate(E, u, t, r); }});
    }
    const NeoHookeanHex hex(nu, h);
    all.push_back({"neo-Hookean", HexElement::BBar, nu,
                   [hex](const HexCorners& u, Tangent t, HexResponse& r) { return hex.evaluate(E, u, t, r); }});
  }
  return all;
}

HexCorners corners() {
  HexCorners X;
  for (int a = 0; a < 8; ++a) X.col(a) = Eigen::Vector3d(a & 1, a >> 1 & 1, a >> 2 & 1).cwiseProduct(h);
  return X;
}

HexCorners noise(double size, std::uint64_t seed) {
  Random random(seed);
  HexCorners u;
  for (double& v : u.reshaped()) v = size * (2 * random.uniform() - 1);
  return u;
}

Eigen::Matrix3d turn(double angle_deg, const Eigen::Vector3d& axis = {1, 2, -1}) {
  return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
}

TEST(LargeDeformationElement, RigidMotionsOfAnySizeCostNothing) {
  for (const Case& c : cases())
    for (const double angle : {1e-6, 1.0, 30.0, 90.0, 135.0, 179.0, 180.0}) {
      const HexCorners u =
          ((turn(angle) - Eigen::Matrix3d::Identity()) * corners()).colwise() + Eigen::Vector3d(1, 2, 3);
      HexResponse r;
      ASSERT_TRUE(c.evaluate(u, Tangent::None, r)) << c.name << angle;
      // A translation of metres leaves 1e-16 m in each corner: strains of 1e-13.
      EXPECT_LE(std::abs(r.energy_J), 1e-15 * E * h.prod()) << c.name << angle;
      EXPECT_LE(r.force_N.cwiseAbs().maxCoeff(), 2e-11 * E * h.maxCoeff() * h.maxCoeff()) << c.name << angle;
    }
}

TEST(LargeDeformationElement, TurningTheBodyTurnsTheForces) {
  const Eigen::Matrix3d R = turn(140);
  for (const Case& c : cases()) {
    const HexCorners u = noise(3e-4, 3);
    HexResponse still, turned;
    ASSERT_TRUE(c.evaluate(u, Tangent::None, still));
    ASSERT_TRUE(c.evaluate(R * (corners() + u) - corners(), Tangent::None, turned));
    EXPECT_NEAR(turned.energy_J, still.energy_J, 1e-11 * still.energy_J) << c.name;
    EXPECT_LE((turned.force_N.reshaped(3, 8) - R * still.force_N.reshaped(3, 8)).norm(), 1e-11 * still.force_N.norm());
  }
}

TEST(LargeDeformationElement, ForceIsTheGradientOfTheEnergyAndTheTangentThatOfTheForce) {
  for (const Case& c : cases())
    for (const double size : {2e-4, 7e-4}) {
      const HexCorners u = turn(50) * (corners() + noise(size, 5)) - corners();
      HexResponse r, plus, minus;
      ASSERT_TRUE(c.evaluate(u, Tangent::Exact, r)) << c.name;
      const double step = 1e-8;
      HexVector force;
      HexMatrix tangent;
      for (int i = 0; i < 24; ++i) {
        HexCorners to = u, from = u;
        to.reshaped()[i] += step;
        from.reshaped()[i] -= step;
        ASSERT_TRUE(c.evaluate(to, Tangent::None, plus) && c.evaluate(from, Tangent::None, minus));
        force[i] = (plus.energy_J - minus.energy_J) / (2 * step);
        tangent.col(i) = (plus.force_N - minus.force_N) / (2 * step);
      }
      EXPECT_LE((force - r.force_N).norm(), 1e-6 * r.force_N.norm()) << c.name << c.poisson;
      EXPECT_LE((tangent - r.tangent_N_m).norm(), 1e-6 * r.tangent_N_m.norm()) << c.name << c.poisson;
      EXPECT_LE((r.tangent_N_m - r.tangent_N_m.transpose()).norm(), 1e-14 * r.tangent_N_m.norm());
      // No net force, no net moment about the deformed places.
      const HexCorners f = r.force_N.reshaped(3, 8);
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      for (int a = 0; a < 8; ++a) moment += (corners() + u).col(a).cross(f.col(a));
      EXPECT_LE(f.rowwise().sum().norm(), 1e-12 * f.norm()) << c.name;
      EXPECT_LE(moment.norm(), 1e-12 * f.norm() * h.norm()) << c.name;
    }
}

TEST(LargeDeformationElement, ThePositiveTangentIsPositive) {
  for (const Case& c : cases()) {
    HexCorners u = -0.5 * corners() + noise(4e-4, 7);  // half the size: strongly compressed
    HexResponse exact, positive;
    ASSERT_TRUE(c.evaluate(u, Tangent::Exact, exact) && c.evaluate(u, Tangent::Positive, positive));
    const Eigen::VectorXd l = Eigen::SelfAdjointEigenSolver<HexMatrix>(exact.tangent_N_m).eigenvalues();
    const Eigen::VectorXd p = Eigen::SelfAdjointEigenSolver<HexMatrix>(positive.tangent_N_m).eigenvalues();
    EXPECT_LT(l[0], -1e-6 * l[23]) << "the case tests nothing: " << c.name;
    EXPECT_GT(p[0], -1e-12 * p[23]) << c.name;
  }
}

TEST(LargeDeformationElement, SmallStrainIsTheLinearElementToRounding) {
  for (const Case& c : cases()) {
    const HexMatrix K = E * hexStiffness(c.linear, c.poisson, h);
    double previous = 0;
    for (const double size : {1e-4, 1e-5, 1e-6}) {  // relative to the element; the difference falls as the strain
      const HexCorners u = size * noise(h.x(), 9);
      HexResponse r;
      ASSERT_TRUE(c.evaluate(u, Tangent::None, r));
      const HexVector linear = K * u.reshaped();
      const double difference = (r.force_N - linear).norm() / linear.norm();
      EXPECT_LE(difference, 10 * size / (1 - 2 * c.poisson)) << c.name;
      if (previous > 0) {
        EXPECT_NEAR(previous / difference, 10, 0.5) << c.name;
      }
      previous = difference;
    }
    const HexCorners u = 1e-13 * noise(h.x(), 9);
    HexResponse r;
    ASSERT_TRUE(c.evaluate(u, Tangent::Exact, r));
    const HexVector linear = K * u.reshaped();
    EXPECT_LE((r.force_N - linear).norm(), 1e-10 * linear.norm()) << c.name;
    EXPECT_LE((r.tangent_N_m - K).norm(), 1e-10 * K.norm()) << c.name;
  }
}

TEST(LargeDeformationElement, RefusesTheInsideOut) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  for (const Case& c : cases()) {
    HexResponse r;
    EXPECT_FALSE(c.evaluate((mirror - Eigen::Matrix3d::Identity()) * corners(), Tangent::None, r)) << c.name;
  }
}

TEST(PolarRotation, IsTheRotationOfAnyStretch) {
  Eigen::Matrix3d stretch;
  stretch << 1.6, 0.2, 0.1, 0.2, 0.5, -0.1, 0.1, -0.1, 1.1;
  for (const double angle : {0.0, 1e-9, 20.0, 120.0, 180.0}) {
    const Eigen::Matrix3d R = turn(angle);
    const auto Z = rotationLessIdentity(R * stretch - Eigen::Matrix3d::Identity());
    ASSERT_TRUE(Z);
    EXPECT_LE((*Z + Eigen::Matrix3d::Identity() - R).norm(), 1e-14);
  }
  // Tiny rotations keep their digits.
  Eigen::Matrix3d H;
  H << 0, -1e-13, 0, 1e-13, 0, 0, 0, 0, 0;
  EXPECT_LE((*rotationLessIdentity(H) - H).norm(), 1e-25);
}

}  // namespace
}  // namespace glisson::mechanics
