// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/hex_element.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/error.h"
#include "base/random.h"

namespace glisson::mechanics {
namespace {

const std::array<HexElement, 3> elements = {HexElement::H8, HexElement::BBar, HexElement::Incompatible};
const std::array<Eigen::Vector3d, 3> boxes = {Eigen::Vector3d(1.64e-3, 1.64e-3, 1.64e-3),
                                              Eigen::Vector3d(1.64e-3, 1.64e-3, 10e-3),
                                              Eigen::Vector3d(1e-3, 7e-3, 2e-3)};

/// Corner positions of a box at the origin.
Eigen::Vector3d corner(int a, const Eigen::Vector3d& h) {
  return Eigen::Vector3d(a & 1, a >> 1 & 1, a >> 2 & 1).cwiseProduct(h);
}

TEST(HexElement, IsSymmetricWithExactlySixZeroModes) {
  for (const HexElement element : elements)
    for (const Eigen::Vector3d& h : boxes)
      for (const double nu : {0.0, 0.3, 0.45, 0.499}) {
        const HexMatrix K = hexStiffness(element, nu, h);
        const double size = K.cwiseAbs().maxCoeff();
        EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * size);
        const Eigen::VectorXd l = Eigen::SelfAdjointEigenSolver<HexMatrix>(K).eigenvalues();
        EXPECT_LE(std::abs(l[0]), 1e-12 * l[23]);
        EXPECT_LE(std::abs(l[5]), 1e-12 * l[23]);
        EXPECT_GT(l[6], 1e-6 * l[23]);
      }
}

TEST(HexElement, RigidMotionCostsNothing) {
  for (const HexElement element : elements)
    for (const Eigen::Vector3d& h : boxes) {
      const HexMatrix K = hexStiffness(element, 0.45, h);
      for (int mode = 0; mode < 6; ++mode) {
        Eigen::Matrix<double, 24, 1> u;
        for (int a = 0; a < 8; ++a)
          u.segment<3>(3 * a) = mode < 3 ? Eigen::Vector3d(1e-2 * Eigen::Vector3d::Unit(mode))
                                         : Eigen::Vector3d(Eigen::Vector3d::Unit(mode - 3).cross(corner(a, h)));
        EXPECT_LE((K * u).norm(), 1e-13 * K.norm() * u.norm());
      }
    }
}

TEST(HexElement, ConstantStrainGivesTheExactNodalForces) {
  // Patch test on one box: f_a = ∫ Bᵀ σ dV with the constant stress, whatever the element.
  Random random(3);
  for (const HexElement element : elements)
    for (const Eigen::Vector3d& h : boxes) {
      const double nu = 0.45;
      Eigen::Matrix3d A;
      for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = random.normal();
      Eigen::Matrix<double, 24, 1> u;
      for (int a = 0; a < 8; ++a) u.segment<3>(3 * a) = A * corner(a, h);
      const Eigen::Matrix<double, 6, 24> B = hexStrain(h, Eigen::Vector3d::Zero());
      const Eigen::Matrix<double, 24, 1> exact = h.prod() * B.transpose() * elasticity(nu) * B * u;
      EXPECT_LE((hexStiffness(element, nu, h) * u - exact).norm(), 1e-13 * exact.norm());
    }
}

TEST(HexElement, IncompatibleModesBendExactly) {
  // Pure bending about z at ν = 0: curvature κ, energy ½ E I κ² L. Trilinear elements are too stiff; this one is exact.
  const Eigen::Vector3d h(2e-3, 1e-3, 3e-3);
  Eigen::Matrix<double, 24, 1> u;
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d p = corner(a, h) - 0.5 * h;
    u.segment<3>(3 * a) = Eigen::Vector3d(p.x() * p.y(), -0.5 * p.x() * p.x(), 0);
  }
  const double exact = 0.5 * h.z() * std::pow(h.y(), 3) / 12 * h.x();
  EXPECT_NEAR(0.5 * u.dot(hexStiffness(HexElement::Incompatible, 0, h) * u), exact, 1e-12 * exact);
  EXPECT_GT(0.5 * u.dot(hexStiffness(HexElement::H8, 0, h) * u), 1.5 * exact);
}

TEST(HexElement, WalshBlocksRebuildTheMatrix) {
  for (const HexElement element : elements)
    for (const Eigen::Vector3d& h : boxes) {
      const HexMatrix K = hexStiffness(element, 0.49, h);
      const auto blocks = walshBlocks(K);
      HexMatrix again = HexMatrix::Zero();
      const auto sign = [](int a, int m) { return __builtin_parity(static_cast<unsigned>(a & m)) ? -1.0 : 1.0; };
      for (int p = 0; p < 8; ++p)
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d)
            for (int a = 0; a < 8; ++a)
              for (int b = 0; b < 8; ++b)
                again(3 * a + c, 3 * b + d) +=
                    sign(a, p ^ (1 << c)) * sign(b, p ^ (1 << d)) * blocks[static_cast<std::size_t>(p)](c, d);
      EXPECT_LE((again - K).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
    }
  HexMatrix skewed = hexStiffness(HexElement::H8, 0.3, boxes[0]);
  skewed(0, 0) *= 1.01;
  EXPECT_THROW(walshBlocks(skewed), BadArgument);
}

TEST(HexElement, MassSumsToTheVolume) {
  for (const Eigen::Vector3d& h : boxes) {
    const auto M = hexMass(h);
    EXPECT_NEAR(M.sum(), h.prod(), 1e-14 * h.prod());
    // ∫ N_a x dV exactly: x is in the element's space.
    Eigen::Matrix<double, 8, 1> x;
    for (int a = 0; a < 8; ++a) x[a] = corner(a, h).x();
    EXPECT_NEAR(x.dot(M * x), h.prod() * h.x() * h.x() / 3, 1e-14 * h.prod() * h.x() * h.x());
  }
}

TEST(HexElement, RefusesWhatIsNoMaterial) {
  EXPECT_THROW(hexStiffness(HexElement::H8, 0.5, boxes[0]), BadArgument);
  EXPECT_THROW(hexStiffness(HexElement::H8, -1, boxes[0]), BadArgument);
  EXPECT_THROW(hexStiffness(HexElement::H8, 0.3, Eigen::Vector3d(1, 0, 1)), BadArgument);
}

}  // namespace
}  // namespace glisson::mechanics
