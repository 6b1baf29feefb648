// SPDX-License-Identifier: GPL-3.0-or-later

// What the lines over an image look like, pixel by pixel.
#include <gtest/gtest.h>

#include <QImage>
#include <QPainter>
#include <cmath>

#include "views/line_work.h"

namespace glisson::views {
namespace {

constexpr int side = 120;
const QColor colour(255, 209, 71);

QImage drawn(const QList<QPolygonF>& outlines, bool closed, bool dashed, double ratio = 1.0) {
  QImage image(QSize(side, side) * ratio, QImage::Format_RGB32);
  image.setDevicePixelRatio(ratio);
  image.fill(Qt::white);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  LineWork lines(QRectF(0, 0, side, side));
  for (const QPolygonF& outline : outlines) lines.add(outline, closed, colour, 2.0, dashed);
  lines.paint(painter);
  return image;
}

bool coloured(QRgb pixel) {
  return std::abs(qRed(pixel) - colour.red()) < 8 && std::abs(qBlue(pixel) - colour.blue()) < 8;
}

/// Lengths of the coloured runs along a row.
std::vector<int> runsOf(const QImage& image, int row) {
  std::vector<int> runs;
  bool in = false;
  for (int x = 0; x < image.width(); ++x) {
    const bool now = coloured(image.pixel(x, row));
    if (now && !in) runs.push_back(0);
    if (now) ++runs.back();
    in = now;
  }
  return runs;
}

TEST(LineWork, LineLiesOnADarkHaloAndNothingElseChanges) {
  const QImage image = drawn({{{{-50.0, 60.0}, {200.0, 60.0}}}}, false, false);
  for (int x = 0; x < side; ++x) {
    EXPECT_TRUE(coloured(image.pixel(x, 60))) << x;
    EXPECT_TRUE(coloured(image.pixel(x, 59))) << x;
    for (const int y : {58, 61}) EXPECT_NEAR(qRed(image.pixel(x, y)), 255 * 0.4, 3) << x << " " << y;
    for (const int y : {56, 63}) EXPECT_EQ(image.pixel(x, y), qRgb(255, 255, 255)) << x << " " << y;
  }
}

TEST(LineWork, CrossingLinesHaveOneHalo) {
  // Where the halos of two lines lie on each other it is no darker than one, and no halo lies on a line.
  const QImage image = drawn(
      {{{{0.0, 40.0}, {120.0, 40.0}}}, {{{40.0, 0.0}, {40.0, 120.0}}}, {{{0.0, 43.0}, {120.0, 43.0}}}}, false, false);
  for (int x = 0; x < side; ++x)
    if (std::abs(x - 40) > 4) {
      EXPECT_TRUE(coloured(image.pixel(x, 40))) << x;
      EXPECT_NEAR(qRed(image.pixel(x, 41)), 255 * 0.4, 3) << x;
    }
}

TEST(LineWork, DashesGoOnAroundTheVertices) {
  // The same straight line as two points and as 1001: short segments must not turn dashes into a solid line.
  QPolygonF dense;
  for (int i = 0; i <= 1000; ++i) dense << QPointF(0.12 * i, 60.0);
  const QImage few = drawn({{{{0.0, 60.0}, {120.0, 60.0}}}}, false, true);
  const QImage many = drawn({dense}, false, true);
  const auto runs = runsOf(few, 60), denseRuns = runsOf(many, 60);
  ASSERT_EQ(runs.size(), 8U);  // a period of 15 pixels
  ASSERT_EQ(denseRuns.size(), runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_NEAR(denseRuns[i], runs[i], 1);
}

TEST(LineWork, CutToTheViewLooksAsUncut) {
  // A dashed line from far away, at phases that a cut line would lose.
  for (const double far : {-150.0, -1500.0, -150000.0}) {
    const QImage seen = drawn({{{{far, 60.0}, {1e6, 60.0}}}}, false, true);
    const QImage near = drawn({{{{0.0, 60.0}, {150.0, 60.0}}}}, false, true);
    for (int x = 0; x < side; ++x)
      EXPECT_EQ(coloured(seen.pixel(x, 60)), coloured(near.pixel(x, 60))) << far << " " << x;
  }
  // Outlines around the view and beside it leave no trace.
  const QImage none =
      drawn({{{{-1e5, -1e5}, {1e5, -1e5}, {1e5, 1e5}, {-1e5, 1e5}}}, {{{300.0, 0.0}, {400.0, 50.0}, {300.0, 90.0}}}},
            true, false);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) ASSERT_EQ(none.pixel(x, y), qRgb(255, 255, 255));
}

TEST(LineWork, ClosedOutlineReturnsToItsFirstPoint) {
  const QPolygonF triangle({{20.0, 20.0}, {100.0, 20.0}, {20.0, 100.0}});
  EXPECT_TRUE(coloured(drawn({triangle}, true, false).pixel(20, 60)));
  EXPECT_FALSE(coloured(drawn({triangle}, false, false).pixel(20, 60)));
}

TEST(LineWork, SharpOnFineScreens) {
  const QImage image = drawn({{{{0.0, 60.0}, {120.0, 60.0}}}}, false, false, 2.0);
  for (const int y : {118, 119, 120, 121}) EXPECT_TRUE(coloured(image.pixel(100, y))) << y;
  for (const int y : {117, 122}) EXPECT_NEAR(qRed(image.pixel(100, y)), 255 * 0.4, 3) << y;
}

}  // namespace
}  // namespace glisson::views
