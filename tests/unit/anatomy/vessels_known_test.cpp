// SPDX-License-Identifier: GPL-3.0-or-later

// Vessels of synthetic patients against their true centre lines, and of real images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "anatomy/vessels.h"
#include "anatomy/voxelise.h"
#include "image/io.h"
#include "image/morphology.h"
#include "lattices.h"
#include "phantom/phantom.h"
#include "support/support.h"

namespace glisson::anatomy {
namespace {

double nearestTruth(const phantom::PhantomTruth& truth, const Eigen::Vector3d& p) {
  double least = 1e9;
  for (const phantom::VesselBranch& b : truth.vessels)
    for (std::size_t i = 1; i < b.points_lps_mm.size(); ++i)
      least = std::min(least, test::distanceToSegment(p, b.points_lps_mm[i - 1], b.points_lps_mm[i]));
  return least;
}

constexpr double voxel_mm = 1.64;

// What is found lies on a true vessel: 1.64 mm in-plane voxels, 2.5 mm planes.
class VesselsOfPhantoms : public ::testing::TestWithParam<int> {};

TEST_P(VesselsOfPhantoms, LieOnTheTrueCentreLines) {
  const phantom::PhantomPatient patient = phantom::makePhantom(static_cast<std::uint64_t>(GetParam()));
  image::ScalarVolume mri(patient.mri.grid);
  std::copy(patient.mri.values.begin(), patient.mri.values.end(), mri.values.begin());
  const VesselModel v = findVessels(mri, patient.liver);
  ASSERT_FALSE(v.centreline_lps_mm.empty()) << v.note;
  std::vector<double> off;
  for (const Eigen::Vector3d& p : v.centreline_lps_mm) off.push_back(nearestTruth(patient.truth, p));
  std::sort(off.begin(), off.end());
  double mean = 0.0;
  for (const double d : off) mean += d / static_cast<double>(off.size());
  const double p95 = off[static_cast<std::size_t>(0.95 * static_cast<double>(off.size() - 1))];
  EXPECT_LT(mean, voxel_mm);
  EXPECT_LT(p95, 2 * voxel_mm);

  // The true lines that are at least four voxels wide are found.
  double wide = 0.0, found = 0.0;
  for (const phantom::VesselBranch& b : patient.truth.vessels) {
    if (b.radius_mm < 2 * voxel_mm) continue;
    for (const Eigen::Vector3d& p : b.points_lps_mm) {
      const Eigen::Vector3i voxel = patient.liver.grid.lpsToIndex(p).array().round().cast<int>();
      if (!patient.liver.grid.contains(voxel) || !patient.liver.at(voxel)) continue;
      double least = 1e9;
      for (const Eigen::Vector3d& q : v.centreline_lps_mm) least = std::min(least, (p - q).norm());
      wide += 1.0;
      if (least < b.radius_mm) found += 1.0;
    }
  }
  ASSERT_GT(wide, 0.0);
  EXPECT_GT(found / wide, 0.95);
  std::printf("  %s; off the true lines %.2f mm mean, %.2f mm for 95 %%; %.0f %% of the wide ones found\n",
              v.note.c_str(), mean, p95, 100 * found / wide);

  // No landmark hangs in the air: it lies in what is drawn, also where a branch is one voxel wide.
  const image::Mask drawn = voxelise(v.surface, v.mask.grid);
  std::size_t outside = 0;
  for (const Eigen::Vector3d& p : v.centreline_lps_mm)
    outside += drawn.at(Eigen::Vector3i(drawn.grid.lpsToIndex(p).array().round().cast<int>())) == 0 ? 1 : 0;
  EXPECT_LE(100 * outside, v.centreline_lps_mm.size()) << outside;
  EXPECT_NEAR(static_cast<double>(image::count(drawn)) / static_cast<double>(image::count(v.mask)), 1.0, 0.25);

  // A forest: every branch starts at the end of its parent, one order further from the root, parents first. Each tree
  // has one branch without a parent, for a root is an end: nothing else leaves it.
  ASSERT_FALSE(v.tree.branches.empty());
  int roots = 0;
  for (int i = 0; const VesselBranch& b : v.tree.branches) {
    EXPECT_LT(b.parent, i++);
    if (b.parent < 0) {
      EXPECT_EQ(b.order, 1);
      ++roots;
      continue;
    }
    const VesselBranch& parent = v.tree.branches[static_cast<std::size_t>(b.parent)];
    EXPECT_EQ(b.order, parent.order + 1);
    EXPECT_EQ(b.points_lps_mm.front(), parent.points_lps_mm.back());
  }
  EXPECT_EQ(roots, v.tree.roots);
}

INSTANTIATE_TEST_SUITE_P(Seeds, VesselsOfPhantoms, ::testing::Range(1, 6));

// No truth is known here: the search must end with vessels inside the liver, or say that there are none.
TEST(RealData, VesselsOfRealImages) {
  GLISSON_NEEDS_DATA("liver_mr_ct_volumes");
  const auto folder = ::glisson::test::sharedData() / "liver_mr_ct_volumes";
  const std::pair<const char*, const char*> pairs[] = {{"example_mr_sm.nii.gz", "example_seg_mr.nii.gz"},
                                                       {"example_ct_sm.nii.gz", "example_seg.nii.gz"}};
  for (const auto& [image, labels] : pairs) {
    const image::ScalarVolume mri = image::readVolume(folder / image);
    const image::Mask liver = image::readMask(folder / labels, 5);
    const VesselModel v = findVessels(mri, liver);
    std::printf("  %s: %s (contrast %.0f); %zu branches in %d trees, %d loops opened, %.0f mm\n", image, v.note.c_str(),
                v.contrast, v.tree.branches.size(), v.tree.roots, v.tree.loopsCut, v.tree.length_mm());
    EXPECT_FALSE(v.note.empty());
    for (const Eigen::Vector3d& p : v.centreline_lps_mm) {
      const auto voxel = liver.grid.lpsToIndex(p).array().round().cast<int>().matrix().eval();
      ASSERT_TRUE(liver.grid.contains(voxel));
      EXPECT_NE(liver.at(voxel), 0);
    }
  }
}

}  // namespace
}  // namespace glisson::anatomy
