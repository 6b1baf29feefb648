// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/propose.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "image/io.h"
#include "roi/agreement.h"
#include "support/support.h"

namespace glisson::roi {
namespace {

image::Grid lattice() {
  image::Grid g;
  g.size = {70, 60, 24};
  g.spacing_mm = {2.0, 2.0, 4.0};
  g.origin_lps_mm = {-60, -70, 10};
  g.direction = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  return g;
}

bool inOrgan(const Eigen::Vector3d& index) {
  return ((index - Eigen::Vector3d(28, 30, 12)).cwiseQuotient(Eigen::Vector3d(18, 20, 9))).norm() < 1.0;
}
bool inNeighbour(const Eigen::Vector3d& index) {
  return ((index - Eigen::Vector3d(58, 30, 12)).cwiseQuotient(Eigen::Vector3d(9, 12, 8))).norm() < 1.0;
}

/// An organ of 300, a neighbour of the same brightness, a bridge of 6 mm between both, a rod far off, a vessel of 500
/// through the organ, 80 elsewhere; noise.
image::ScalarVolume scene(image::Mask& organ) {
  const image::Grid g = lattice();
  image::ScalarVolume v(g);
  organ = image::Mask(g);
  Random random(3);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d at(i, j, k);
        const bool bridge = std::abs(j - 30) < 2 && std::abs(k - 12) < 1 && i > 28 && i < 58;
        const bool rod = j > 1 && j < 4 && std::abs(k - 12) < 1;
        const bool vessel = inOrgan(at) && std::abs(j - 22) < 2 && std::abs(k - 12) < 1;
        organ.at(i, j, k) = inOrgan(at) ? 1 : 0;
        v.at(i, j, k) = static_cast<float>((vessel                                            ? 500.0
                                            : inOrgan(at) || inNeighbour(at) || bridge || rod ? 300.0
                                                                                              : 80.0) +
                                           25.0 * random.normal());
      }
  return v;
}

TEST(Propose, TakesTheOrganWithoutItsNeighbourAndWithItsVessels) {
  image::Mask organ;
  const image::ScalarVolume image = scene(organ);
  const Proposal p = propose(image, image.grid.indexToLps({26, 36, 13}));
  const Agreement a = agreement(organ, p.mask);
  RecordProperty("dice", std::to_string(a.dice));
  EXPECT_GT(a.dice, 0.95);
  EXPECT_EQ(p.mask.at(58, 30, 12), 0);
  EXPECT_EQ(p.mask.at(28, 22, 12), 1);  // the vessel
  EXPECT_FALSE(p.touchesBorder);
  EXPECT_NEAR(p.volume_mL, a.volumeB_mL, 1e-9);
  // The neighbour is smaller than an organ is expected to be.
  EXPECT_THROW(propose(image, image.grid.indexToLps({59, 31, 12})), BadInput);
  const Proposal neighbour = propose(image, image.grid.indexToLps({59, 31, 12}), {.least_mL = 10.0});
  EXPECT_EQ(neighbour.mask.at(26, 36, 13), 0);
  EXPECT_EQ(neighbour.mask.at(59, 31, 12), 1);
}

TEST(Propose, RefusesASeedOutsideTheImageOrInAThinThing) {
  image::Mask organ;
  const image::ScalarVolume image = scene(organ);
  EXPECT_THROW(propose(image, {1000, 0, 0}), BadInput);
  EXPECT_THROW(propose(image, image.grid.indexToLps({35, 2, 12}), {.seedRadius_mm = 2.0}), BadInput);  // rod
}

TEST(Propose, ShadingAndVesselsMakeNoDifference) {
  image::Mask organ;
  const image::ScalarVolume even = scene(organ);
  image::ScalarVolume shaded = even;
  for (int k = 0; k < even.grid.size.z(); ++k)
    for (int j = 0; j < even.grid.size.y(); ++j)
      for (int i = 0; i < even.grid.size.x(); ++i)
        shaded.at(i, j, k) *= static_cast<float>(1.0 + 0.2 * (i - 28) / 36.0);  // 20 % over the organ
  for (const auto& click : {Eigen::Vector3d(16, 34, 12), Eigen::Vector3d(40, 30, 10), Eigen::Vector3d(28, 44, 14)})
    EXPECT_GT(agreement(organ, propose(shaded, shaded.grid.indexToLps(click)).mask).dice, 0.93) << click.transpose();
  // In the vessel itself: its surroundings are meant.
  EXPECT_GT(agreement(organ, propose(even, even.grid.indexToLps({28, 22, 12})).mask).dice, 0.93);
}

TEST(Propose, AirIsNoOrganAndALeakIsSaid) {
  image::Grid g = lattice();
  g.size = {60, 60, 40};
  g.spacing_mm = {3.0, 3.0, 3.0};
  Random random(5);
  image::ScalarVolume image(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d at =
            (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(30, 30, 20)).cwiseQuotient(Eigen::Vector3d(27, 27, 18));
        const bool fat = std::abs(i - 30) < 3;
        image.at(i, j, k) = static_cast<float>((at.norm() > 1.0 ? 5.0 : fat ? 120.0 : 400.0) + 8.0 * random.normal());
      }
  const auto saidAt = [&](const Eigen::Vector3d& click, const ProposalOptions& options = {}) -> std::string {
    try {
      return std::to_string(propose(image, g.indexToLps(click), options).volume_mL);
    } catch (const BadInput& e) {
      return e.what();
    }
  };
  EXPECT_NE(saidAt({2, 2, 2}).find("in air"), std::string::npos) << saidAt({2, 2, 2});
  // Each half of this body has some 640 mL.
  EXPECT_NE(saidAt({14, 30, 20}, {.most_mL = 400.0}).find("leaks"), std::string::npos);
  EXPECT_NEAR(std::stod(saidAt({14, 30, 20})), 640.0, 100.0);
}

// A real T1-weighted liver; the mask beside it was made by a network. Any click in its parenchyma gives the same.
TEST(Propose, RealLiver) {
  GLISSON_NEEDS_DATA("liver_mr_ct_volumes");
  const auto folder = test::sharedData() / "liver_mr_ct_volumes";
  const image::ScalarVolume mr = image::readVolume(folder / "example_mr_sm.nii.gz");
  const image::Mask liver = image::readMask(folder / "example_seg_mr.nii.gz", 5);
  for (const auto& seed : {Eigen::Vector3d(22, 45, 10), Eigen::Vector3d(28, 40, 14), Eigen::Vector3d(20, 50, 6),
                           Eigen::Vector3d(17, 35, 11), Eigen::Vector3d(33, 20, 13)}) {
    const Proposal p = propose(mr, mr.grid.indexToLps(seed));
    const Agreement a = agreement(liver, p.mask);
    std::printf("real liver: Dice %.3f, %.0f mL against %.0f mL, 95 %% of the surface within %.1f mm\n", a.dice,
                p.volume_mL, a.volumeA_mL, a.hausdorff95_mm);
    EXPECT_GT(a.dice, 0.88);
    EXPECT_TRUE(p.touchesBorder);  // the field of view cuts this liver
  }
}

}  // namespace
}  // namespace glisson::roi
