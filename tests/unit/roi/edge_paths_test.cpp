// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/edge_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/random.h"

namespace glisson::roi {
namespace {

const Eigen::Vector2d middle(52.3, 47.6);
constexpr double radius = 30.0;

/// A disc on dark ground, with partial volume at its border and noise; pixel units.
image::ScalarVolume disc(double noise) {
  image::Grid grid;
  grid.size = {110, 100, 2};
  image::ScalarVolume image(grid);
  Random random(4);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const double in = std::clamp(radius - (Eigen::Vector2d(i, j) - middle).norm() + 0.5, 0.0, 1.0);
        image.at(i, j, k) = static_cast<float>(100.0 + 80.0 * (k == 1 ? in : 0.0) + noise * random.normal());
      }
  return image;
}

Eigen::Vector2d onCircle(double turns) {
  const double t = 2.0 * std::numbers::pi * turns;
  return middle + radius * Eigen::Vector2d(std::cos(t), std::sin(t));
}

TEST(EdgePaths, AQuarterOfACircleIsFollowedToAPartOfAPixel) {
  EdgePaths paths(disc(6.0), 1);
  for (const double from : {0.0, 0.13, 0.4, 0.77}) {
    paths.startAt(onCircle(from));
    const Eigen::Matrix2Xd way = paths.to(onCircle(from + 0.25));
    ASSERT_GT(way.cols(), 25);
    double sum = 0.0, worst = 0.0;
    for (Eigen::Index v = 0; v < way.cols(); ++v) {
      const double off = std::abs((way.col(v) - middle).norm() - radius);
      sum += off;
      worst = std::max(worst, off);
    }
    EXPECT_LT(sum / static_cast<double>(way.cols()), 0.3) << from;
    EXPECT_LT(worst, 1.0) << from;
    EXPECT_LT((way.col(0) - onCircle(from)).norm(), 0.75);
    EXPECT_LT((way.rightCols(1) - onCircle(from + 0.25)).norm(), 0.75);
  }
}

TEST(EdgePaths, WhereNothingChangesTheWayIsStraight) {
  EdgePaths paths(disc(0.0), 0);
  paths.startAt({10, 20});
  const Eigen::Matrix2Xd way = paths.to({60, 20});
  ASSERT_EQ(way.cols(), 51);
  for (Eigen::Index v = 0; v < way.cols(); ++v) EXPECT_DOUBLE_EQ(way(1, v), 20.0);
}

TEST(EdgePaths, WhatWasFoundBeforeChangesNothing) {
  EdgePaths much(disc(6.0), 1), fresh(disc(6.0), 1);
  much.startAt(onCircle(0.1));
  for (const double t : {0.2, 0.5, 0.9}) much.to(onCircle(t));
  fresh.startAt(onCircle(0.1));
  EXPECT_EQ(much.to(onCircle(0.35)), fresh.to(onCircle(0.35)));
}

TEST(EdgePaths, PlacesBesideTheImageAreItsBorderAndSlicesThatItHasNotAreRefused) {
  EdgePaths paths(disc(0.0), 0);
  paths.startAt({-50, -50});
  const Eigen::Matrix2Xd way = paths.to({1000, -3});
  EXPECT_EQ(way.col(0), Eigen::Vector2d(0, 0));
  EXPECT_EQ(way.rightCols(1), Eigen::Vector2d(109, 0));
  EXPECT_THROW(EdgePaths(disc(0.0), 2), BadArgument);
  EXPECT_THROW(EdgePaths(disc(0.0), -1), BadArgument);
}

}  // namespace
}  // namespace glisson::roi
