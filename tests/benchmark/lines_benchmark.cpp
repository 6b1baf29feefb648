// SPDX-License-Identifier: GPL-3.0-or-later

// Outlines over an image: segments cut to the view on one halo (views/line_work) beside Qt's stroker on whole paths.

#include <benchmark/benchmark.h>

#include <QImage>
#include <QPainter>
#include <QPainterPath>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "views/line_work.h"

namespace {

constexpr int side = 800;
const QColor colour(255, 209, 71);

/// Jagged rings of some vertices each, scattered over the view; radius in pixels.
QList<QPolygonF> rings(int count, int vertices, double radius) {
  glisson::Random random(3);
  QList<QPolygonF> all;
  for (int r = 0; r < count; ++r) {
    const QPointF centre(random.uniform(0.0, side), random.uniform(0.0, side));
    QPolygonF ring;
    for (int v = 0; v < vertices; ++v) {
      const double angle = 2.0 * std::numbers::pi * v / vertices;
      ring << centre + radius * random.uniform(0.5, 1.5) * QPointF(std::cos(angle), std::sin(angle));
    }
    all << ring;
  }
  return all;
}

template <typename Draw>
void measure(benchmark::State& state, const Draw& draw) {
  const auto all =
      rings(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), static_cast<double>(state.range(2)));
  QImage image(side, side, QImage::Format_RGB32);
  image.fill(Qt::gray);
  for (auto _ : state) {
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    draw(painter, all, state.range(3) != 0);
  }
}

void lineWork(benchmark::State& state) {
  measure(state, [](QPainter& painter, const QList<QPolygonF>& all, bool dashed) {
    glisson::views::LineWork lines(QRectF(0, 0, side, side));
    for (const QPolygonF& ring : all) lines.add(ring, true, colour, 1.5, dashed);
    lines.paint(painter);
  });
}

void stroker(benchmark::State& state) {
  measure(state, [](QPainter& painter, const QList<QPolygonF>& all, bool dashed) {
    for (const QPolygonF& ring : all) {
      QPainterPath path;
      path.addPolygon(ring);
      path.closeSubpath();
      painter.setPen(QPen(QColor(0, 0, 0, 150), 3.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
      painter.drawPath(path);
      QPen pen(colour, 1.5, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
      if (dashed) pen.setDashPattern({4.0, 3.5});
      painter.setPen(pen);
      painter.drawPath(path);
    }
  });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"outlines", "vertices", "radius", "dashed"})->Unit(benchmark::kMillisecond);
  for (const int dashed : {0, 1})
    b->Args({1, 60, 200, dashed})
        ->Args({1, 400, 200, dashed})
        ->Args({20, 60, 150, dashed})
        ->Args({20, 60, 5000, dashed});
}
BENCHMARK(lineWork)->Apply(sizes);
BENCHMARK(stroker)->Apply(sizes);

}  // namespace
