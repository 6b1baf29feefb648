// SPDX-License-Identifier: GPL-3.0-or-later

// Squares drawn with real mouse events on shifted, anisotropic, oblique and flipped grids: the mask holds exactly the
// voxels whose centres lie inside.
#include <QSignalSpy>
#include <QTest>
#include <cmath>

#include "roi/contour_stack.h"
#include "tools/polygon_tool.h"
#include "views/slice_view.h"

using glisson::image::Grid;
using glisson::views::SliceView;

class Grids : public QObject {
  Q_OBJECT

 private slots:
  void squares_data() {
    QTest::addColumn<int>("kind");
    QTest::addColumn<double>("shift");
    for (const double shift : {0.0, 0.25, 0.5, 0.75})
      for (int kind = 0; kind < 5; ++kind)
        QTest::addRow("%s, shifted %.2f",
                      std::array{"plain", "anisotropic", "oblique", "flipped row",
                                 "flipped slice"}[static_cast<std::size_t>(kind)],
                      shift)
            << kind << shift;
  }

  void squares() {
    QFETCH(int, kind);
    QFETCH(double, shift);
    Grid grid;
    grid.size = {48, 40, 5};
    grid.spacing_mm = {2.0, 2.0, 5.0};
    if (kind > 0) grid.spacing_mm = {1.7, 2.6, 8.0};
    grid.origin_lps_mm = {-37.3, 12.9, 55.1};
    if (kind >= 2)
      grid.direction =
          (Eigen::AngleAxisd(0.31, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.24, Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
    if (kind == 3) grid.direction.col(0) *= -1.0, grid.direction.col(1) *= -1.0;
    if (kind == 4) grid.direction.col(2) *= -1.0;
    glisson::views::ShownVolume shown;
    shown.values = std::make_shared<glisson::image::ScalarVolume>(grid, 1.0F);
    SliceView view;
    view.resize(700, 600);
    view.setVolume(shown);
    glisson::roi::ContourStack contours;
    glisson::tools::PolygonTool tool(contours);
    view.setContours(&contours, &tool);
    const auto apply = [&](const glisson::tools::Acts& acts) {
      for (const auto& act : acts)
        if (const auto* add = std::get_if<glisson::tools::AddPolygon>(&act)) contours.polygons.push_back(add->polygon);
    };
    connect(&view, &SliceView::toolPressed, &view, [&](const auto& at) { apply(tool.press(at, view.plane())); });
    connect(&view, &SliceView::toolMoved, &view, [&](const auto& at) { apply(tool.move(at, view.plane())); });
    connect(&view, &SliceView::toolReleased, &view, [&](const auto& at) { apply(tool.release(at, view.plane())); });
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    view.setSlice(3);
    // Corners near these indices; the mouse has whole pixels, so the indices that were hit are computed from them.
    const double low_i = 9.0 + shift, low_j = 7.0 + shift, high_i = 30.0 + shift, high_j = 25.0 + shift;
    double li = 0, lj = 0, hi = 0, hj = 0;
    const auto at = [&](double i, double j) {
      const Eigen::Vector2d px = view.plane().toPixel(grid.indexToLps({i, j, 3.0}));
      return QPoint(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y())));
    };
    const QPoint a = at(low_i, low_j), c = at(high_i, high_j);
    for (const QPoint p : {a, QPoint(c.x(), a.y()), c, QPoint(a.x(), c.y())})
      QTest::mouseClick(&view, Qt::LeftButton, {}, p);
    apply(tool.key(glisson::tools::ToolKey::CtrlEnter, view.plane()));
    QCOMPARE(contours.polygons.size(), std::size_t{1});
    const auto indexOf = [&](const QPoint& p) {
      return grid.lpsToIndex(view.plane().toLps({static_cast<double>(p.x()), static_cast<double>(p.y())}));
    };
    li = std::min(indexOf(a).x(), indexOf(c).x()), hi = std::max(indexOf(a).x(), indexOf(c).x());
    lj = std::min(indexOf(a).y(), indexOf(c).y()), hj = std::max(indexOf(a).y(), indexOf(c).y());
    QVERIFY(std::abs(li - std::min(low_i, high_i)) < 0.2);
    const auto mask = glisson::roi::rasterise(contours, grid);
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          const double edge = std::min({std::abs(i - li), std::abs(i - hi), std::abs(j - lj), std::abs(j - hj)});
          if (edge < 1e-6) continue;  // on the edge: the tie rule, tested with the rasteriser
          const bool in = k == 3 && i > li && i < hi && j > lj && j < hj;
          QCOMPARE(mask.at(i, j, k) != 0, in);
        }
  }
};

QTEST_MAIN(Grids)
#include "grids_test.moc"
