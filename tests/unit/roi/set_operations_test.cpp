// SPDX-License-Identifier: GPL-3.0-or-later
#include "roi/set_operations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "roi/contour_stack.h"
#include "roi/detail/slabs.h"

namespace glisson::roi {
namespace {

using Ring = Eigen::Matrix2Xd;
using Rings = std::vector<Ring>;

Ring ring(std::initializer_list<std::pair<double, double>> points) {
  Ring r(2, static_cast<Eigen::Index>(points.size()));
  Eigen::Index v = 0;
  for (const auto& [x, y] : points) r.col(v++) = Eigen::Vector2d(x, y);
  return r;
}

Ring square(double x, double y, double side) {
  return ring({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

FlatRegion region(Rings rings) {
  FlatRegion r{std::move(rings), {}};
  r.flips.assign(r.rings_mm.size(), false);
  return r;
}

/// Area of a set by another method: trapezoids between the heights of vertices and crossings.
double slabArea(const Rings& rings, const Membership& belongs) {
  double area = 0.0;
  detail::forTrapezoids(rings, [&](const std::vector<bool>& in, double part) { area += belongs(in) ? part : 0.0; });
  return area;
}

/// How often the rings run round a point, anticlockwise.
int winding(const Rings& rings, const Eigen::Vector2d& p) {
  int turns = 0;
  for (const Ring& r : rings)
    for (Eigen::Index v = 0; v < r.cols(); ++v) {
      const Eigen::Vector2d a = r.col(v) - p, b = r.col((v + 1) % r.cols()) - p;
      const double side = a.x() * b.y() - a.y() * b.x();
      if (a.y() <= 0.0 && b.y() > 0.0 && side > 0.0) ++turns;
      if (a.y() > 0.0 && b.y() <= 0.0 && side < 0.0) --turns;
    }
  return turns;
}

bool oddInside(const Ring& r, const Eigen::Vector2d& p) {
  return winding({r}, p) % 2 != 0;
}

/// Rings as boundaryOf promises them: no vertex twice in one ring, no edge twice.
void expectSimple(const Rings& rings) {
  std::set<std::array<double, 4>> edges;
  for (const Ring& r : rings) {
    std::set<std::pair<double, double>> vertices;
    for (Eigen::Index v = 0; v < r.cols(); ++v) {
      const Eigen::Vector2d a = r.col(v), b = r.col((v + 1) % r.cols());
      EXPECT_TRUE(vertices.insert({a.x(), a.y()}).second) << "a ring touches itself";
      EXPECT_TRUE(edges.insert({a.x(), a.y(), b.x(), b.y()}).second) << "an edge comes twice";
      EXPECT_FALSE(edges.contains({b.x(), b.y(), a.x(), a.y()})) << "an edge is run over both ways";
    }
  }
}

constexpr SetOperation all[] = {SetOperation::Union, SetOperation::Difference, SetOperation::Intersection};

bool holdsFor(SetOperation op, bool a, bool b) {
  return op == SetOperation::Union ? a || b : op == SetOperation::Difference ? a && !b : a && b;
}

/// Every operation on two even-odd rings against slabs, sample points, and the sum of areas.
void check(const Ring& a, const Ring& b, Random& random, double reach) {
  std::map<SetOperation, double> area;
  const auto size =
      slabArea({a}, [](const auto& in) { return in[0]; }) + slabArea({b}, [](const auto& in) { return in[0]; });
  for (const SetOperation op : all) {
    const Rings result = boundaryOf({a, b}, [op](const std::vector<bool>& in) { return holdsFor(op, in[0], in[1]); });
    expectSimple(result);
    area[op] = signedArea_mm2(result);
    EXPECT_NEAR(area[op], slabArea({a, b}, [op](const auto& in) { return holdsFor(op, in[0], in[1]); }), 1e-9 * size);
    for (int n = 0; n < 60; ++n) {
      const Eigen::Vector2d p(random.uniform(-0.1 * reach, 1.1 * reach), random.uniform(-0.1 * reach, 1.1 * reach));
      EXPECT_EQ(winding(result, p), holdsFor(op, oddInside(a, p), oddInside(b, p)) ? 1 : 0);
    }
  }
  EXPECT_NEAR(area[SetOperation::Union] + area[SetOperation::Intersection], size, 1e-9 * size);
  EXPECT_NEAR(area[SetOperation::Difference] + area[SetOperation::Intersection],
              slabArea({a}, [](const auto& in) { return in[0]; }), 1e-9 * size);
}

TEST(SetOperations, RandomOutlinesThatCrossThemselvesAndEachOther) {
  Random random(11);
  for (int n = 0; n < 150; ++n) {
    const auto any = [&] {
      Ring r(2, 3 + static_cast<Eigen::Index>(random.below(20)));
      for (Eigen::Index v = 0; v < r.cols(); ++v)
        r.col(v) = Eigen::Vector2d(random.uniform(0, 200), random.uniform(0, 200));
      return r;
    };
    const Ring a = any(), b = any();
    check(a, b, random, 200.0);
  }
}

TEST(SetOperations, LatticesWhereAlmostEverythingTouchesOrCoincides) {
  Random random(12);
  for (int n = 0; n < 600; ++n) {
    const auto any = [&] {
      Ring r(2, 3 + static_cast<Eigen::Index>(random.below(8)));
      for (Eigen::Index v = 0; v < r.cols(); ++v)
        r.col(v) = Eigen::Vector2d(static_cast<double>(random.below(6)), static_cast<double>(random.below(6)));
      return r;
    };
    const Ring a = any(), b = random.uniform() < 0.1 ? a : any();
    check(a, b, random, 5.0);
  }
}

TEST(SetOperations, OutlinesOfThousandsOfVerticesFarFromTheOrigin) {
  const auto wavy = [](double x, double phase) {
    Ring r(2, 1500);
    for (Eigen::Index v = 0; v < r.cols(); ++v) {
      const double t = 2.0 * std::numbers::pi * static_cast<double>(v) / static_cast<double>(r.cols());
      const double radius = 80.0 + 6.0 * std::sin(40.0 * t + phase);
      r.col(v) = Eigen::Vector2d(x + radius * std::cos(t), -640.0 + radius * std::sin(t));
    }
    return r;
  };
  const Ring a = wavy(700.0, 0.0), b = wavy(701.0, 0.7);
  const double size = signedArea_mm2({a}) + signedArea_mm2({b});
  double sum = 0.0;
  for (const SetOperation op : {SetOperation::Union, SetOperation::Intersection}) {
    const Rings result = boundaryOf({a, b}, [op](const std::vector<bool>& in) { return holdsFor(op, in[0], in[1]); });
    expectSimple(result);
    sum += signedArea_mm2(result);
  }
  EXPECT_NEAR(sum, size, 1e-9 * size);
}

TEST(SetOperations, NestedOutlinesAreHolesAndTheirUnionIsTheOuterOne) {
  const Ring outer = square(0, 0, 10), inner = square(3, 3, 4);
  EXPECT_DOUBLE_EQ(signedArea_mm2(combined(region({outer}), region({inner}), SetOperation::Union).rings_mm), 100.0);
  const FlatRegion ringWithHole = combined(region({outer}), region({inner}), SetOperation::Difference);
  EXPECT_EQ(ringWithHole.rings_mm.size(), 2u);
  EXPECT_DOUBLE_EQ(signedArea_mm2(ringWithHole.rings_mm), 84.0);
  // As outlines of a slice: a disc that covers hole and tissue fills what it covers.
  const FlatRegion filled = combined(region({outer, inner}), region({square(3, 3, 2)}), SetOperation::Union);
  EXPECT_DOUBLE_EQ(signedArea_mm2(filled.rings_mm), 88.0);
}

TEST(SetOperations, NeighboursJoinAlongAnEdgeAndStayApartAtACorner) {
  const Rings joined = combined(region({square(0, 0, 5)}), region({square(5, 1, 2)}), SetOperation::Union).rings_mm;
  ASSERT_EQ(joined.size(), 1u);
  EXPECT_DOUBLE_EQ(signedArea_mm2(joined), 29.0);
  EXPECT_EQ(combined(region({square(0, 0, 5)}), region({square(5, 5, 2)}), SetOperation::Union).rings_mm.size(), 2u);
  EXPECT_TRUE(
      combined(region({square(0, 0, 5)}), region({square(5, 1, 2)}), SetOperation::Intersection).rings_mm.empty());
  EXPECT_TRUE(meet(square(0, 0, 5), square(5, 1, 2)));
  EXPECT_TRUE(meet(square(0, 0, 5), square(1, 1, 2)));
  EXPECT_FALSE(meet(square(0, 0, 5), square(5, 5, 2)));
  EXPECT_FALSE(meet(square(0, 0, 5), square(5.001, 1, 2)));
}

TEST(SetOperations, AHoleThatTouchesTheBorderInOnePointIsARingOfItsOwn) {
  const Ring outer = square(0, 0, 10), diamond = ring({{10, 5}, {8, 7}, {6, 5}, {8, 3}});
  const Rings result = combined(region({outer}), region({diamond}), SetOperation::Difference).rings_mm;
  expectSimple(result);
  EXPECT_EQ(result.size(), 2u);
  EXPECT_DOUBLE_EQ(signedArea_mm2(result), 92.0);
}

TEST(SetOperations, AnOutlineThatCrossesItselfCountsByTheEvenOddRule) {
  const Ring bowTie = ring({{0, 0}, {4, 4}, {4, 0}, {0, 4}});
  const Rings parts = combined(region({bowTie}), region({}), SetOperation::Union).rings_mm;
  EXPECT_EQ(parts.size(), 2u);
  EXPECT_DOUBLE_EQ(signedArea_mm2(parts), 8.0);
}

TEST(SetOperations, VerticesThatStayKeepTheirBits) {
  Ring a = square(0.1, 0.2, 10.3);
  a *= std::numbers::pi;
  const Rings result = combined(region({a}), region({square(25, 25, 20)}), SetOperation::Union).rings_mm;
  ASSERT_EQ(result.size(), 1u);
  for (const Eigen::Index corner : {0, 1, 3}) {
    bool kept = false;
    for (Eigen::Index v = 0; v < result[0].cols(); ++v) kept = kept || result[0].col(v) == a.col(corner);
    EXPECT_TRUE(kept) << corner;
  }
  // Nothing but what crosses is new: three old corners, three of the square, two crossings.
  EXPECT_EQ(result[0].cols(), 8);
}

TEST(SetOperations, RoundingOfCoordinatesLeavesNoSlivers) {
  Random random(13);
  Ring a(2, 40), b(2, 40);
  for (Eigen::Index v = 0; v < 40; ++v) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(v) / 40.0;
    a.col(v) = Eigen::Vector2d(300.0 + 70.0 * std::cos(t), -200.0 + 50.0 * std::sin(t));
    b.col(v) = a.col(v) + 1e-12 * Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
  }
  EXPECT_EQ(combined(region({a}), region({b}), SetOperation::Union).rings_mm.size(), 1u);
  EXPECT_EQ(combined(region({a}), region({b}), SetOperation::Intersection).rings_mm.size(), 1u);
  EXPECT_TRUE(combined(region({a}), region({b}), SetOperation::Difference).rings_mm.empty());
}

TEST(SetOperations, AThinRingIsNotTakenForAnOutlineDrawnTwice) {
  const FlatRegion thin =
      combined(region({square(0, 0, 40)}), region({square(0.2, 0.2, 39.6)}), SetOperation::Difference);
  ASSERT_EQ(thin.rings_mm.size(), 2u);
  ContourStack stack;
  for (std::size_t r = 0; r < 2; ++r) {
    Polygon polygon;
    polygon.points_lps_mm = Eigen::Matrix3Xd::Zero(3, thin.rings_mm[r].cols());
    polygon.points_lps_mm.topRows(2) = thin.rings_mm[r];
    polygon.combine = thin.flips[r] ? Combine::Parity : Combine::Union;
    stack.polygons.push_back(polygon);
  }
  EXPECT_NEAR(area_mm2(stack), 1600.0 - 39.6 * 39.6, 1e-6);
  // A ring that is wide enough needs no such thing.
  for (const bool flips :
       combined(region({square(0, 0, 40)}), region({square(9, 9, 9)}), SetOperation::Difference).flips)
    EXPECT_FALSE(flips);
}

TEST(SetOperations, CoordinatesThatAreNoneAreRefused) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto any = [](const std::vector<bool>& in) { return in[0]; };
  EXPECT_THROW(boundaryOf({ring({{0, 0}, {1, none}, {1, 1}})}, any), BadInput);
  EXPECT_THROW(boundaryOf({ring({{0, 0}, {1e7, 0}, {1, 1}})}, any), BadInput);
  EXPECT_TRUE(boundaryOf({ring({{0, 0}, {5, 5}})}, any).empty());
  // A kilometre away the lattice is coarser, and that is all.
  EXPECT_NEAR(signedArea_mm2(boundaryOf({square(999000, -999000, 100)}, any)), 1e4, 1e-4);
}

}  // namespace
}  // namespace glisson::roi
