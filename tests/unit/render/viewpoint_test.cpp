// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/viewpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace glisson::render {
namespace {

using Eigen::Vector3d;

constexpr View3D views[] = {View3D::Anterior, View3D::Posterior, View3D::Left,   View3D::Right,
                            View3D::Superior, View3D::Inferior,  View3D::Oblique};

Viewpoint at(double azimuth_deg, double elevation_deg) {
  SceneOptions3D options;
  options.camera = Camera3D{azimuth_deg, elevation_deg};
  return viewpointOf(options);
}

Viewpoint at(View3D view) {
  SceneOptions3D options;
  options.view = view;
  return viewpointOf(options);
}

void expectSame(const Viewpoint& a, const Viewpoint& b) {
  EXPECT_LT((a.fromEye - b.fromEye).norm(), 1e-12);
  EXPECT_LT((a.up - b.up).norm(), 1e-12);
  EXPECT_LT((a.right - b.right).norm(), 1e-12);
  EXPECT_EQ(a.walls, b.walls);
}

/// Cameras all around, with both poles.
std::vector<Viewpoint> manyViewpoints() {
  std::vector<Viewpoint> all;
  for (int azimuth = -180; azimuth <= 180; azimuth += 15)
    for (int elevation = -90; elevation <= 90; elevation += 15) all.push_back(at(azimuth, elevation));
  for (const View3D view : views) all.push_back(at(view));
  return all;
}

TEST(Viewpoint, isARightHandedFrame) {
  for (const Viewpoint& v : manyViewpoints()) {
    EXPECT_NEAR(v.fromEye.norm(), 1.0, 1e-12);
    EXPECT_NEAR(v.up.norm(), 1.0, 1e-12);
    EXPECT_NEAR(v.right.norm(), 1.0, 1e-12);
    EXPECT_NEAR(v.up.dot(v.fromEye), 0.0, 1e-12);
    EXPECT_LT((v.right.cross(v.up) + v.fromEye).norm(), 1e-12) << "the eye is where right x up points";
  }
}

TEST(Viewpoint, presetsFollowRadiologicalConvention) {
  // From the front the patient's left is on the right of the picture, as in a slice.
  EXPECT_LT((at(View3D::Anterior).right - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Anterior).up - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Anterior).fromEye - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Posterior).right + Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Left).fromEye + Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Right).fromEye - Vector3d::UnitX()).norm(), 1e-12);
  // From below as in axial slices: anterior up, the patient's left on the right.
  EXPECT_LT((at(View3D::Inferior).up + Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Inferior).right - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((at(View3D::Superior).up + Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Viewpoint, anglesAreThoseOfThePresets) {
  expectSame(at(0, 0), at(View3D::Anterior));
  expectSame(at(90, 0), at(View3D::Left));
  expectSame(at(-90, 0), at(View3D::Right));
  expectSame(at(0, 90), at(View3D::Superior));
  expectSame(at(0, -90), at(View3D::Inferior));
  expectSame(at(-30, 20), at(330, 20));
}

TEST(Viewpoint, refusesWhatIsNoCamera) {
  EXPECT_THROW(at(0, 90.5), BadArgument);
  EXPECT_THROW(at(0, std::numeric_limits<double>::quiet_NaN()), BadArgument);
  EXPECT_THROW(at(std::numeric_limits<double>::infinity(), 0), BadArgument);
}

TEST(Viewpoint, wallsLieBehindTheScene) {
  for (const Viewpoint& v : manyViewpoints()) {
    ASSERT_FALSE(v.walls.empty());
    EXPECT_NEAR(std::abs(v.fromEye[v.walls.front().first]), v.fromEye.cwiseAbs().maxCoeff(), 1e-9);
    for (const auto& [axis, upper] : v.walls)
      EXPECT_GT(v.fromEye[axis] * (upper ? 1.0 : -1.0), 0.0) << "a wall hides nothing";
  }
}

TEST(LabelledEdges, oneForEveryAxisThatIsSeenAndTheOutermostOfItsWalls) {
  const Eigen::AlignedBox3d box(Vector3d(-140, -80, -100), Vector3d(60, 80, 90));
  for (const Viewpoint& v : manyViewpoints()) {
    const std::vector<LabelledEdge> edges = labelledEdges(v, box);
    std::vector<int> expected, found;
    for (int axis = 0; axis < 3; ++axis)  // an edge along an axis lies on walls across the other two
      if (std::abs(v.fromEye[axis]) <= 0.95 &&
          std::any_of(v.walls.begin(), v.walls.end(), [axis](const auto& wall) { return wall.first != axis; }))
        expected.push_back(axis);
    for (const LabelledEdge& edge : edges) found.push_back(edge.axis);
    EXPECT_EQ(found, expected);
    for (const LabelledEdge& edge : edges) {
      for (int a = 0; a < 3; ++a)
        EXPECT_TRUE(edge.low[a] == box.min()[a] || (a != edge.axis && edge.low[a] == box.max()[a]));
      EXPECT_NEAR(edge.outward.norm(), 1.0, 1e-12);
      EXPECT_NEAR(edge.outward.dot(v.fromEye), 0.0, 1e-12) << "labels are moved in the picture, not towards the eye";
      // Of the parallel edges on walls none lies further out.
      const int b = (edge.axis + 1) % 3, c = (edge.axis + 2) % 3;
      for (const bool upperB : {false, true})
        for (const bool upperC : {false, true}) {
          Vector3d other = box.min();
          if (upperB) other[b] = box.max()[b];
          if (upperC) other[c] = box.max()[c];
          const bool onWall = std::any_of(v.walls.begin(), v.walls.end(), [&](const auto& wall) {
            return wall == std::pair(b, upperB) || wall == std::pair(c, upperC);
          });
          if (onWall) {
            EXPECT_LE(other.dot(edge.outward), edge.low.dot(edge.outward) + 1e-6);
          }
        }
    }
  }
}

}  // namespace
}  // namespace glisson::render
