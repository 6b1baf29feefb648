// SPDX-License-Identifier: GPL-3.0-or-later

// Livers of odd shapes: each is odd in its own way, in one piece, with room for its vessels.
#include <gtest/gtest.h>

#include <map>

#include "base/parallel.h"
#include "image/components.h"
#include "image/morphology.h"
#include "phantom/detail/torso.h"
#include "phantom/phantom.h"

namespace glisson::phantom {
namespace {

image::Mask liverOf(const Torso& torso) {
  image::Grid g;
  g.spacing_mm = Point(4, 4, 4);
  g.origin_lps_mm = Point(-168, -116, torso.liverBottom_mm() - 4.0);
  g.size = Eigen::Vector3i(80, 59, static_cast<int>((torso.liverTop_mm() - torso.liverBottom_mm()) / 4.0) + 3);
  image::Mask m(g);
  parallelChunks(static_cast<std::size_t>(g.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < g.size.y(); ++j)
        for (int i = 0; i < g.size.x(); ++i) {
          const Point p = g.indexToLps(Point(i, j, k));
          m.at(i, j, k) = torso.body_mm(p) < 0.0 && torso.liver_mm(p) < 0.0 ? 1 : 0;
        }
  });
  return m;
}

/// What tells one shape from another, mm and mL.
struct Figures {
  double height = 0, width = 0, volume = 0, left = 0;  ///< left: share of the volume left of the vena cava
  double thickness = 0;  ///< from front to back, mean over the right lobe's lower half, where there is liver
  double largestPiece = 0;
};

Figures figuresOf(const image::Mask& m) {
  const auto e = image::extentOf(m).value();
  Figures f;
  f.height = 4.0 * (e.high.z() - e.low.z() + 1);
  f.width = 4.0 * (e.high.x() - e.low.x() + 1);
  const auto all = static_cast<double>(image::count(m));
  f.volume = all * 0.064;
  f.largestPiece = static_cast<double>(image::count(image::largestComponent(m))) / all;
  int columns = 0;
  for (int k = e.low.z(); k <= e.high.z(); ++k)
    for (int i = e.low.x(); i <= e.high.x(); ++i) {
      int column = 0;
      for (int j = 0; j < m.grid.size.y(); ++j) column += m.at(i, j, k);
      const double x = m.grid.indexToLps(Point(i, 0, k)).x();
      if (x > -24.0) f.left += column / all;
      if (column == 0 || x > -60.0 || k > (e.low.z() + e.high.z()) / 2) continue;
      f.thickness += 4.0 * column;
      ++columns;
    }
  f.thickness /= std::max(1, columns);
  return f;
}

TEST(Shapes, EachIsOddInItsOwnWay) {
  for (const std::uint64_t seed : {77, 2024}) {
    std::map<LiverShape, Figures> of;
    for (const auto& [shape, name] : liverShapes) {
      const Torso torso(seed, shape);  // throws where its vessels find no way in
      const image::Mask liver = liverOf(torso);
      of[shape] = figuresOf(liver);
      EXPECT_GT(image::extentOf(liver).value().low.z(), 0) << name << ": reaches below its lowest plane";
      EXPECT_GT(of[shape].largestPiece, 0.995) << name;
      EXPECT_NEAR(of[shape].volume, torso.targetVolume_mL(), 0.03 * torso.targetVolume_mL()) << name;
    }
    const Figures& usual = of[LiverShape::Usual];
    EXPECT_LT(of[LiverShape::Short].height, 0.75 * usual.height);
    EXPECT_GT(of[LiverShape::Wide].width, usual.width + 40.0);
    EXPECT_LT(of[LiverShape::Wide].height, usual.height - 15.0);
    EXPECT_LT(of[LiverShape::ThinLobe].thickness, 0.65 * usual.thickness);
    EXPECT_GT(of[LiverShape::Riedel].height, usual.height + 50.0);
    EXPECT_GT(of[LiverShape::LargeLeft].left, usual.left + 0.15);
  }
}

TEST(Shapes, OfNoneGivenIsTheUsual) {
  const Torso plain(5), usual(5, LiverShape::Usual);
  for (double z = -120; z < 90; z += 13.0)
    for (double y = -100; y < 100; y += 11.0)
      for (double x = -150; x < 120; x += 9.0) ASSERT_EQ(plain.liver_mm({x, y, z}), usual.liver_mm({x, y, z}));
  EXPECT_EQ(PhantomOptions{}.shape, LiverShape::Usual);
  for (const auto& [shape, name] : liverShapes) {
    EXPECT_EQ(nameOf(shape), name);
    EXPECT_EQ(liverShapeNamed(name), shape);
  }
  EXPECT_FALSE(liverShapeNamed("round"));
}

}  // namespace
}  // namespace glisson::phantom
