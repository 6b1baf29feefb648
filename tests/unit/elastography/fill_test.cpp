// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/fill.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/morphology.h"

namespace glisson::elastography {
namespace {

image::Grid mreGrid() {
  image::Grid g;
  g.size = {80, 70, 4};
  g.spacing_mm = {1.64, 1.64, 10.0};
  g.origin_lps_mm = {-60, -50, 100};
  g.direction = Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return g;
}

image::Grid bodyGrid() {
  image::Grid g;
  g.size = {70, 60, 30};
  g.spacing_mm = {2.0, 2.0, 3.0};
  g.origin_lps_mm = {-65, -55, 80};
  return g;
}

/// Ellipsoid about a common centre, scaled.
image::Mask ellipsoid(const image::Grid& g, double scale) {
  image::Mask m(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d p = g.indexToLps(Eigen::Vector3d(i, j, k)) - Eigen::Vector3d(4, 4, 118);
        m.at(i, j, k) = p.cwiseQuotient(scale * Eigen::Vector3d(45, 38, 30)).norm() < 1.0 ? 1 : 0;
      }
  return m;
}

double meanInside(const image::ScalarVolume& v, const image::Mask& m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < m.values.size(); ++i)
    if (m.values[i] != 0) sum += static_cast<double>(v.values[i]);
  return sum / static_cast<double>(image::count(m));
}

TEST(FillStiffness, ConstantStaysConstantWhateverLiesAround) {
  StiffnessMap map = makeStiffnessMap(image::ScalarVolume(mreGrid(), 900.0F), StiffnessQuantity::Shear, "kPa");
  const image::Mask roi = ellipsoid(mreGrid(), 0.9);
  Random random(1);
  image::ScalarVolume confidence(mreGrid(), 1.0F);
  for (std::size_t v = 0; v < roi.values.size(); ++v) {
    if (roi.values[v] != 0) map.values_kPa.values[v] = 2.1F;
    if (random.uniform() < 0.3) {
      confidence.values[v] = 0.5F;
      map.values_kPa.values[v] = 77.0F;
    }
  }
  attachConfidence(map, confidence);
  const image::Mask body = ellipsoid(bodyGrid(), 1.0);
  const FilledStiffness filled = fillStiffness(map, body, &roi);
  for (std::size_t v = 0; v < body.values.size(); ++v)
    ASSERT_NEAR(filled.values_kPa.values[v], body.values[v] != 0 ? 2.1 : 0.0, 2e-6);
  EXPECT_GT(filled.filledFraction, 0.05);
  EXPECT_LT(filled.filledFraction, 0.6);
  EXPECT_GT(filled.farthest_mm, 3.0);
}

TEST(FillStiffness, MeanOfANoisyMapIsKept) {
  const image::Mask roi = ellipsoid(mreGrid(), 1.0), body = ellipsoid(bodyGrid(), 1.0);
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    StiffnessMap map = makeStiffnessMap(image::ScalarVolume(mreGrid(), 0.3F), StiffnessQuantity::Shear, "kPa");
    image::ScalarVolume confidence(mreGrid(), 1.0F);
    for (std::size_t v = 0; v < roi.values.size(); ++v) {
      if (roi.values[v] != 0) map.values_kPa.values[v] = static_cast<float>(3.0 + 0.3 * random.normal());
      if (random.uniform() < 0.2) confidence.values[v] = 0.1F;
    }
    attachConfidence(map, confidence);
    const double mean_kPa = meanInside(fillStiffness(map, body, &roi).values_kPa, body);
    worst = std::max(worst, std::abs(mean_kPa / 3.0 - 1.0));
  }
  RecordProperty("worst_relative_bias", std::to_string(worst));
  EXPECT_LT(worst, 0.005);
}

TEST(FillStiffness, LinearFieldIsExactBetweenTrustedVoxels) {
  StiffnessMap map = makeStiffnessMap(image::ScalarVolume(mreGrid()), StiffnessQuantity::Youngs, "kPa");
  auto field = [](const Eigen::Vector3d& p) { return 10.0 + 0.02 * p.x() - 0.03 * p.y() + 0.05 * (p.z() - 118); };
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 70; ++j)
      for (int i = 0; i < 80; ++i)
        map.values_kPa.at(i, j, k) = static_cast<float>(field(mreGrid().indexToLps(Eigen::Vector3d(i, j, k))));
  const image::Mask body = ellipsoid(bodyGrid(), 0.25);  // wholly between the first and the last slice centre
  const FilledStiffness filled = fillStiffness(map, body);
  EXPECT_EQ(filled.filledFraction, 0.0);
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 70; ++i)
        if (body.at(i, j, k) != 0) {
          ASSERT_NEAR(filled.values_kPa.at(i, j, k), field(bodyGrid().indexToLps(Eigen::Vector3d(i, j, k))), 1e-5);
        }
}

TEST(FillStiffness, SameBitsWithAnyNumberOfThreadsAndRefusals) {
  StiffnessMap map = makeStiffnessMap(image::ScalarVolume(mreGrid()), StiffnessQuantity::Shear, "kPa");
  Random random(9);
  for (float& v : map.values_kPa.values) v = static_cast<float>(random.uniform(-1.0, 4.0));
  const image::Mask body = ellipsoid(bodyGrid(), 1.0);
  setThreadCount(1);
  const FilledStiffness one = fillStiffness(map, body);
  setThreadCount(3);
  EXPECT_EQ(fillStiffness(map, body).values_kPa.values, one.values_kPa.values);
  setThreadCount(0);
  EXPECT_THROW(fillStiffness(map, image::Mask(bodyGrid())), BadInput);
  const image::Mask nothing(mreGrid());
  EXPECT_THROW(fillStiffness(map, body, &nothing), BadInput);
}

}  // namespace
}  // namespace glisson::elastography
