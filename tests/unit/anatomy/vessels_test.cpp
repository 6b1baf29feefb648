// SPDX-License-Identifier: GPL-3.0-or-later
#include "anatomy/vessels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "anatomy/centreline.h"
#include "anatomy/detail/thinning.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/components.h"
#include "image/morphology.h"
#include "lattices.h"

namespace glisson::anatomy {
namespace {

using namespace test;
const Eigen::Vector3d centre(10, -30, 120);

struct Tube {
  Eigen::Vector3d a, b;
  double radius_mm;
};

/// A Y: a trunk and two branches in three dimensions.
std::vector<Tube> letterY() {
  const Eigen::Vector3d fork = centre + Eigen::Vector3d(2, 0, 3);
  return {{centre + Eigen::Vector3d(-6, 5, -38), fork, 4.5},
          {fork, centre + Eigen::Vector3d(30, -10, 28), 3.5},
          {fork, centre + Eigen::Vector3d(-24, 14, 30), 3.0}};
}

double depth(const std::vector<Tube>& tubes, const Eigen::Vector3d& p) {
  double d = -1e9;
  for (const Tube& t : tubes) d = std::max(d, t.radius_mm - distanceToSegment(p, t.a, t.b));
  return d;
}

/// Liver of radius 50 mm with vessels, surroundings brighter, shading, noise.
image::ScalarVolume phantom(const image::Grid& g, const std::vector<Tube>& tubes, double noise, std::uint64_t seed) {
  image::ScalarVolume v(g);
  Random random(seed);
  const double soft = 0.5 * g.spacing_mm.mean();  // partial volume
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const Eigen::Vector3d p = g.indexToLps(Eigen::Vector3d(i, j, k));
        const double liver = (p - centre).norm() < 50.0 ? 300.0 : 420.0;
        const double vessel = 150.0 * std::clamp(0.5 + 0.5 * depth(tubes, p) / soft, 0.0, 1.0);
        const double shading = 1.0 + 0.15 * (p - centre).x() / 50.0;
        v.at(i, j, k) = static_cast<float>(shading * (liver + vessel) + noise * random.normal());
      }
  return v;
}

TEST(Skeleton, KeepsTopologyAndIsThin) {
  image::Grid g;
  g.size = {40, 40, 40};
  const Eigen::Vector3d middle(20, 20, 20);
  const image::Mask torus = maskOf(g, [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - middle;
    return std::hypot(std::hypot(d.x(), d.y()) - 12.0, d.z()) < 4.0;
  });
  const image::Mask ring = skeleton(torus);
  // A closed curve: every voxel keeps two neighbours or more, none ends; its length is the torus's middle circle.
  double length = 0.0;
  const Centreline line = centrelineOf(torus);
  for (const auto& e : line.edges)
    length += (line.points_lps_mm[static_cast<std::size_t>(e[0])] - line.points_lps_mm[static_cast<std::size_t>(e[1])])
                  .norm();
  EXPECT_NEAR(length, 2 * std::numbers::pi * 12, 4.0);
  EXPECT_LT(image::count(ring), 90u);
  for (const Eigen::Vector3d& p : line.points_lps_mm) {
    const Eigen::Vector3d d = p - middle;
    EXPECT_LT(std::hypot(std::hypot(d.x(), d.y()) - 12.0, d.z()), 1.0);
  }
  // A ball shrinks to a point or a short line, and stays one part.
  const image::Mask ball = maskOf(g, [&](const Eigen::Vector3d& p) { return (p - middle).norm() < 12; });
  EXPECT_EQ(image::components(skeleton(ball)).voxels.size(), 1u);
  EXPECT_LE(image::count(skeleton(ball)), 12u);  // no longer than its radius
}

TEST(Skeleton, InPlaceKnowsWhatIsLeft) {
  image::Grid g;
  g.size = {30, 24, 20};
  // It touches the border, where neighbours are missing.
  image::Mask mask = maskOf(g, [](const Eigen::Vector3d& p) { return p.y() < 8.0 || (p.x() < 6.0 && p.z() < 9.0); });
  const image::Mask expected = skeleton(mask);
  std::vector<Eigen::Vector3i> voxels = voxelsOf(mask);
  EXPECT_EQ(voxels.size(), image::count(mask));
  thin(mask, voxels);
  EXPECT_EQ(mask.values, expected.values);
  EXPECT_TRUE(voxels == voxelsOf(expected));
  EXPECT_LT(voxels.size(), 200u);
}

TEST(Centreline, TubeHasItsRadiusOnObliqueLattices) {
  for (const double radius : {3.0, 5.0})
    for (const Lattice& l : lattices(centre, 40, {1.2, 1.2, 1.2})) {
      const Eigen::Vector3d half = 30.0 * Eigen::Vector3d(1, 0.6, -0.8).normalized();
      const Tube tube{centre - half, centre + half, radius};
      const image::Mask m = maskOf(l.grid, [&](const Eigen::Vector3d& p) { return depth({tube}, p) > 0; });
      const Centreline line = centrelineOf(m);
      ASSERT_GT(line.points_lps_mm.size(), 30u);
      double sum = 0.0, off = 0.0, worst = 0.0, beyond = 0.0;
      const Eigen::Vector3d along = half.normalized();
      for (std::size_t i = 0; i < line.points_lps_mm.size(); ++i) {
        sum += line.radius_mm[i];
        const Eigen::Vector3d d = line.points_lps_mm[i] - centre;
        beyond = std::max(beyond, std::abs(d.dot(along)) - half.norm());
        off += (d - d.dot(along) * along).norm();
        worst = std::max(worst, (d - d.dot(along) * along).norm());
      }
      const auto n = static_cast<double>(line.points_lps_mm.size());
      std::printf("  tube r %.0f, %s: radius %.2f mm, off the axis %.2f mean %.2f max mm\n", radius, l.name.c_str(),
                  sum / n, off / n, worst);
      // The edge of a mask is known to half a voxel at each of many voxels round the tube, whose errors cancel: a tenth
      // of a voxel is left in the radius, a quarter in the place across the axis, half of one at worst. The line
      // may reach into the round tip as far as the depth there is 0.6 of the tube's, and a voxel more.
      EXPECT_NEAR(sum / n, radius, 0.12) << l.name;
      EXPECT_LT(off / n, 0.3) << l.name;
      EXPECT_LT(worst, 0.6) << l.name;
      EXPECT_LT(beyond, 0.4 * radius + 1.2) << l.name;
    }
}

TEST(Vessels, LetterYIsFoundOnEveryLattice) {
  const std::vector<Tube> tubes = letterY();
  for (const Eigen::Vector3d& spacing : {Eigen::Vector3d(1.5, 1.5, 1.5), Eigen::Vector3d(1.5, 1.5, 3.0)})
    for (const Lattice& l : lattices(centre, 62, spacing)) {
      const image::ScalarVolume mri = phantom(l.grid, tubes, 15.0, 7);
      const image::Mask liver = maskOf(l.grid, [](const Eigen::Vector3d& p) { return (p - centre).norm() < 50; });
      const VesselModel v = findVessels(mri, liver);
      ASSERT_FALSE(v.centreline_lps_mm.empty()) << l.name;
      ASSERT_EQ(v.centreline_lps_mm.size(), v.radius_mm.size());
      const double voxel_mm = 1.5;
      int found = 0, all = 0;
      for (const Tube& t : tubes)
        for (int s = 0; s <= 60; ++s) {
          const Eigen::Vector3d p = t.a + s / 60.0 * (t.b - t.a);
          if ((p - centre).norm() > 46) continue;
          double nearest = 1e9;
          for (const auto& q : v.centreline_lps_mm) nearest = std::min(nearest, (p - q).norm());
          ++all;
          if (nearest <= voxel_mm) ++found;
        }
      int stray = 0;
      double radiusError = 0.0;
      for (std::size_t i = 0; i < v.centreline_lps_mm.size(); ++i) {
        double nearest = 1e9, radius = 0.0;
        for (const Tube& t : tubes)
          if (const double d = distanceToSegment(v.centreline_lps_mm[i], t.a, t.b); d < nearest) {
            nearest = d;
            radius = t.radius_mm;
          }
        if (nearest > 2 * voxel_mm) ++stray;
        radiusError += std::abs(v.radius_mm[i] - radius) / static_cast<double>(v.radius_mm.size());
      }
      const double share = static_cast<double>(found) / all;
      const double strayShare = stray / static_cast<double>(v.centreline_lps_mm.size());
      std::printf(
          "  Y on %s, slices %.1f mm: %.1f %% of the line within %.1f mm; %.1f %% stray; radius off %.2f mm; %s\n",
          l.name.c_str(), spacing.z(), 100 * share, voxel_mm, 100 * strayShare, radiusError, v.note.c_str());
      EXPECT_GE(share, 0.9) << l.name;
      EXPECT_LE(strayShare, 0.05) << l.name;
      EXPECT_LT(radiusError, 0.5) << l.name;  // a third of a voxel
      EXPECT_EQ(v.tree.roots, 1) << l.name;
      EXPECT_EQ(v.tree.branches.size(), 3u) << l.name;
      EXPECT_NEAR(v.contrast, 150.0, 40.0) << l.name;
      EXPECT_TRUE(isClosed(v.surface)) << l.name;
    }
}

TEST(Vessels, NothingIsFoundInAPlainLiver) {
  for (const double noise : {0.0, 15.0, 40.0})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const image::Grid g = lattices(centre, 62, {1.5, 1.5, 3.0})[2].grid;
      const image::Mask liver = maskOf(g, [](const Eigen::Vector3d& p) { return (p - centre).norm() < 50; });
      const VesselModel v = findVessels(phantom(g, {}, noise, seed), liver);
      EXPECT_TRUE(v.centreline_lps_mm.empty()) << "noise " << noise << ": " << v.note;
      EXPECT_FALSE(v.note.empty());
    }
}

TEST(Vessels, DarkVesselsThreadsAndRefusals) {
  const image::Grid g = lattices(centre, 62, {2, 2, 3})[1].grid;
  const image::Mask liver = maskOf(g, [](const Eigen::Vector3d& p) { return (p - centre).norm() < 50; });
  image::ScalarVolume mri = phantom(g, letterY(), 10.0, 3);
  setThreadCount(1);
  const VesselModel bright = findVessels(mri, liver);
  setThreadCount(2);
  EXPECT_EQ(findVessels(mri, liver).centreline_lps_mm, bright.centreline_lps_mm);
  setThreadCount(0);
  for (float& v : mri.values) v = -v;
  VesselOptions dark;
  dark.bright = false;
  EXPECT_EQ(findVessels(mri, liver, dark).mask.values, bright.mask.values);
  EXPECT_THROW(findVessels(mri, image::Mask(g)), BadInput);
  image::Mask away = liver;
  away.grid.origin_lps_mm.x() += 1000;
  EXPECT_THROW(findVessels(mri, away), BadInput);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(findVessels(mri, liver, Progress({}, stop.get_token())), Cancelled);
}

}  // namespace
}  // namespace glisson::anatomy
