// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "phantom/detail/shape.h"
#include "phantom/detail/torso.h"
#include "phantom/detail/vessel_tree.h"
#include "shared_patient.h"

namespace glisson::phantom {
namespace {

class Vessels : public testing::Test {
 protected:
  const std::vector<VesselBranch>& branches() { return test::sharedPatient().truth.vessels; }
};

TEST_F(Vessels, LieInsideTheLiverWithTheirWholeWidth) {
  const Torso torso(test::sharedPatient().truth.seed);
  for (const VesselBranch& b : branches())
    for (const Point& p : b.points_lps_mm) EXPECT_LT(torso.liver_mm(p), -b.radius_mm) << b.name;
}

TEST_F(Vessels, AreTwoConnectedTreesOfManyBranches) {
  std::map<std::string, int> count;
  const auto& all = branches();
  std::map<std::string, Point> root;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const VesselBranch& b = all[i];
    ++count[b.name];
    ASSERT_GE(b.points_lps_mm.size(), 2U);
    if (b.parent < 0) {
      const auto [it, fresh] = root.emplace(b.name, b.points_lps_mm.front());
      EXPECT_TRUE(fresh || (it->second - b.points_lps_mm.front()).norm() < 1e-9);
    } else {
      ASSERT_LT(b.parent, static_cast<int>(i));  // so every chain of parents ends at a root
      const VesselBranch& parent = all[static_cast<std::size_t>(b.parent)];
      EXPECT_EQ(parent.name, b.name);
      EXPECT_LT((parent.points_lps_mm.back() - b.points_lps_mm.front()).norm(), 1e-9);
    }
  }
  ASSERT_EQ(count.size(), 2U);
  EXPECT_GT(count["portal"], 150);
  EXPECT_GT(count["hepatic"], 120);
}

TEST_F(Vessels, ObeyMurraysLawFromTrunkToTwig) {
  const auto& all = branches();
  std::vector<double> cubes(all.size(), 0.0);
  std::map<std::string, double> trunk;
  for (const VesselBranch& b : all) {
    const double cube = b.radius_mm * b.radius_mm * b.radius_mm;
    if (b.parent >= 0) cubes[static_cast<std::size_t>(b.parent)] += cube;
    if (b.parent < 0) trunk[b.name] += cube;
    EXPECT_GT(b.radius_mm, 1.0);
    EXPECT_LT(b.radius_mm, 7.1);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_TRUE(cubes[i] == 0.0 || std::abs(std::cbrt(cubes[i]) - all[i].radius_mm) < 1e-9) << "branch " << i;
  EXPECT_NEAR(std::cbrt(trunk["portal"]), 6.3, 1e-9);
  EXPECT_NEAR(std::cbrt(trunk["hepatic"]), 7.0, 1e-9);
}

TEST_F(Vessels, PortalAndHepaticVeinsNeverTouch) {
  const auto& all = branches();
  double gap = 1e9;
  for (const VesselBranch& a : all)
    for (const VesselBranch& b : all) {
      if (a.name != "portal" || b.name != "hepatic") continue;
      for (std::size_t i = 0; i + 1 < a.points_lps_mm.size(); ++i)
        for (std::size_t j = 0; j + 1 < b.points_lps_mm.size(); ++j)
          gap = std::min(gap, segmentDistance_mm(a.points_lps_mm[i], a.points_lps_mm[i + 1], b.points_lps_mm[j],
                                                 b.points_lps_mm[j + 1]) -
                                  a.radius_mm - b.radius_mm);
    }
  EXPECT_GT(gap, 0.4);
}

TEST_F(Vessels, AreBrighterThanTheLiverAroundThem) {
  const PhantomPatient& p = test::sharedPatient();
  double liver = 0.0;
  std::size_t n = 0;
  for (std::size_t v = 0; v < p.liver.values.size(); ++v)
    if (p.liver.values[v]) {
      liver += p.mri.values[v];
      ++n;
    }
  liver /= static_cast<double>(n);
  std::set<std::string> seen;
  for (const VesselBranch& b : branches()) {
    if (b.radius_mm < 3.0) continue;
    seen.insert(b.name);
    const Eigen::Vector3d index = p.mri.grid.lpsToIndex(b.points_lps_mm[b.points_lps_mm.size() / 2]);
    EXPECT_GT(p.mri.at(index.array().round().cast<int>().matrix()), 1.3 * liver);
  }
  EXPECT_EQ(seen, (std::set<std::string>{"hepatic", "portal"}));
}

TEST(VesselGrowth, FindsRoomForBothTreesInEveryLiver) {
  for (std::uint64_t seed = 100; seed < 112; ++seed) {
    const Torso torso(seed);
    const LiverVessels v = growVessels([&](const Point& p) { return torso.liver_mm(p); },
                                       Point(-165, -115, torso.liverBottom_mm()), Point(120, 110, torso.liverTop_mm()),
                                       torso.portalHilum_lps_mm(), torso.hepaticConfluence_lps_mm(), seed);
    EXPECT_GE(v.portal.leaves(), 120) << seed;
    EXPECT_GE(v.hepatic.leaves(), 96) << seed;
  }
}

}  // namespace
}  // namespace glisson::phantom
