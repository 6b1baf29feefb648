// SPDX-License-Identifier: GPL-3.0-or-later

// A skin on the surface of a body: tension in its plane, folds instead of compression.
#include "mechanics/contact/membrane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

namespace glisson::mechanics {
namespace {

/// One layer of cells whose upper face carries a skin.
struct Sheet {
  Eigen::Vector3i cells{3, 1, 4};
  Eigen::Vector3d h_m{4e-3, 3e-3, 5e-3};
  RowLattice lattice{cells, std::vector<double>(12, 1.0)};
  Membrane membrane;

  explicit Sheet(const Skin& skin, const Eigen::Vector3d& normal = Eigen::Vector3d::UnitY()) {
    std::vector<SkinSample> samples;
    for (int k = 0; k < cells.z(); ++k)
      for (int i = 0; i < cells.x(); ++i) {
        const Eigen::Vector3d middle = Eigen::Vector3d(i + 0.5, 1, k + 0.5).cwiseProduct(h_m);
        samples.push_back({{i, 0, k}, middle, normal, h_m.x() * h_m.z()});
      }
    membrane = Membrane(lattice, h_m, samples, skin);
  }
  std::size_t nodes() const { return lattice.nodeSlots(); }
  double area_m2() const { return cells.x() * cells.z() * h_m.x() * h_m.z(); }
  /// u = (F − I) X at every node.
  std::vector<double> stretched(const Eigen::Matrix3d& F) const {
    std::vector<double> u(3 * nodes(), 0.0);
    for (int k = 0; k <= cells.z(); ++k)
      for (int j = 0; j <= cells.y(); ++j)
        for (int i = 0; i <= cells.x(); ++i) {
          const Eigen::Vector3d v = (F - Eigen::Matrix3d::Identity()) * Eigen::Vector3d(i, j, k).cwiseProduct(h_m);
          for (std::size_t c = 0; c < 3; ++c) u[c * nodes() + lattice.slot(i, j, k)] = v[static_cast<Eigen::Index>(c)];
        }
    return u;
  }
  double energy(const Eigen::Matrix3d& F) const {
    std::vector<double> gradient(3 * nodes() + 1, 0.0);
    return membrane.addForces(stretched(F).data(), nodes(), gradient.data());
  }
};

const Skin skin{250, 0.3, true};

TEST(Membrane, StoresThePlaneStressEnergyOfItsStretch) {
  const Sheet sheet(skin);
  const double a = 1.2, c = 1.1, ea = (a * a - 1) / 2, ec = (c * c - 1) / 2;
  const double perArea = 250 / (1 - 0.09) / 2 * (ea * ea + ec * ec + 2 * 0.3 * ea * ec);
  EXPECT_NEAR(sheet.energy(Eigen::Vector3d(a, 0.7, c).asDiagonal()), perArea * sheet.area_m2(),
              1e-6 * perArea * sheet.area_m2());
  // Turned as a whole it stores nothing.
  EXPECT_NEAR(sheet.energy(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix()), 0, 1e-12);
}

TEST(Membrane, WrinklesInsteadOfBearingCompression) {
  const Sheet sheet(skin);
  EXPECT_EQ(sheet.energy(Eigen::Vector3d(0.9, 1, 0.8).asDiagonal()), 0.0);
  // Pulled along x and far narrower than its contraction: uniaxial tension.
  const double e = (1.2 * 1.2 - 1) / 2;
  EXPECT_NEAR(sheet.energy(Eigen::Vector3d(1.2, 1, 0.5).asDiagonal()), 0.5 * 250 * e * e * sheet.area_m2(), 1e-8);
  const Sheet stiff({250, 0.3, false});
  EXPECT_GT(stiff.energy(Eigen::Vector3d(0.9, 1, 0.8).asDiagonal()), 1e-4);
}

TEST(Membrane, ForceIsTheDerivativeOfTheEnergyAndTangentThatOfTheForce) {
  const Sheet sheet(skin, Eigen::Vector3d(0.3, 0.9, -0.2).normalized());
  const std::size_t n = 3 * sheet.nodes();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> range(-8e-4, 8e-4);
  // Taut along one way, folded along the other, in parts.
  std::vector<double> u = sheet.stretched(Eigen::Vector3d(1.15, 1, 0.9).asDiagonal()), v(n), gradient(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    u[i] += range(random);
    v[i] = range(random);
  }
  const double step = 1e-5;
  std::vector<double> up = u, down = u, above(n + 1, 0.0), below(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    up[i] += step * v[i];
    down[i] -= step * v[i];
  }
  Membrane membrane = sheet.membrane;
  membrane.addForces(u.data(), sheet.nodes(), gradient.data());
  const double energyUp = membrane.addForces(up.data(), sheet.nodes(), above.data());
  const double energyDown = membrane.addForces(down.data(), sheet.nodes(), below.data());
  double work = 0;
  for (std::size_t i = 0; i < n; ++i) work += gradient[i] * v[i];
  EXPECT_NEAR((energyUp - energyDown) / (2 * step), work, 1e-6 * std::abs(work));

  membrane.linearise(u.data(), sheet.nodes());
  std::vector<float> x(n + 1, 0.0F), y(n + 1, 0.0F), blocks(6 * sheet.nodes(), 0.0F);
  for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<float>(v[i]);
  membrane.addTangent(x.data(), sheet.nodes(), y.data());
  double wrong = 0, size = 0, curvature = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double d = (above[i] - below[i]) / (2 * step);
    wrong += std::pow(d - static_cast<double>(y[i]), 2);
    size += d * d;
    curvature += v[i] * static_cast<double>(y[i]);
  }
  EXPECT_LT(std::sqrt(wrong / size), 1e-5);
  EXPECT_GT(curvature, 0);

  // The diagonal block of a node in the middle, column by column.
  membrane.addDiagonal(sheet.nodes(), blocks.data());
  const std::size_t node = sheet.lattice.slot(1, 1, 2);
  constexpr std::array<std::array<std::size_t, 3>, 3> entry = {{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> e(n + 1, 0.0F), column(n + 1, 0.0F);
    e[c * sheet.nodes() + node] = 1.0F;
    membrane.addTangent(e.data(), sheet.nodes(), column.data());
    for (std::size_t r = 0; r < 3; ++r)
      EXPECT_NEAR(column[r * sheet.nodes() + node], blocks[entry[r][c] * sheet.nodes() + node],
                  1e-3F * std::abs(blocks[node]));
  }
}

}  // namespace
}  // namespace glisson::mechanics
