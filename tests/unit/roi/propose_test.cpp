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
  const Proposal neighbour = propose(image, image.grid.indexToLps({59, 31, 12}));
  EXPECT_EQ(neighbour.mask.at(26, 36, 13), 0);
  EXPECT_EQ(neighbour.mask.at(59, 31, 12), 1);
}

TEST(Propose, RefusesASeedOutsideTheImageOrInAThinThing) {
  image::Mask organ;
  const image::ScalarVolume image = scene(organ);
  EXPECT_THROW(propose(image, {1000, 0, 0}), BadInput);
  EXPECT_THROW(propose(image, image.grid.indexToLps({35, 2, 12}), {.seedRadius_mm = 2.0}), BadInput);  // rod
}

// A real T1-weighted liver, one click; the mask beside it was made by a network. Clicks in homogeneous liver.
TEST(Propose, RealLiver) {
  GLISSON_NEEDS_DATA("liver_mr_ct_volumes");
  const auto folder = test::sharedData() / "liver_mr_ct_volumes";
  const image::ScalarVolume mr = image::readVolume(folder / "example_mr_sm.nii.gz");
  const image::Mask liver = image::readMask(folder / "example_seg_mr.nii.gz", 5);
  for (const auto& seed : {Eigen::Vector3d(22, 45, 10), Eigen::Vector3d(28, 40, 14), Eigen::Vector3d(20, 50, 6)}) {
    const Proposal p = propose(mr, mr.grid.indexToLps(seed));
    const Agreement a = agreement(liver, p.mask);
    std::printf("real liver: Dice %.3f, %.0f mL against %.0f mL, 95 %% of the surface within %.1f mm\n", a.dice,
                p.volume_mL, a.volumeA_mL, a.hausdorff95_mm);
    EXPECT_GT(a.dice, 0.85);
    EXPECT_TRUE(p.touchesBorder);  // the field of view cuts this liver
  }
}

}  // namespace
}  // namespace glisson::roi
