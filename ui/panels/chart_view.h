// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>
#include <optional>
#include <variant>

#include "render/charts.h"
#include "session/worker.h"

namespace glisson::panels {

/// A chart drawn for the widget's own size by a worker, that tells where it is clicked.
class ChartView : public QWidget {
  Q_OBJECT
 public:
  using Chart = std::variant<render::Histogram, render::BoxPlot>;

  explicit ChartView(QWidget* parent = nullptr);
  void setChart(Chart chart);
  void setHint(const QString& hint);  ///< shown in place of a chart
  bool isDrawn() const { return chart_ && !image_.isNull() && !worker_.busy() && !wanted_; }
  const std::optional<Chart>& chart() const { return chart_; }

 signals:
  void columnClicked(double low, double high, bool twice);       ///< of a histogram
  void placeClicked(std::size_t box, double value, bool twice);  ///< of a box plot

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  render::ChartSize size_() const;
  void draw();
  void clicked(const QPointF& at, bool twice);
  std::optional<Chart> chart_;
  QImage image_;
  QString hint_;
  session::Worker worker_;
  bool wanted_ = false;  ///< drawn again when the worker is free
};

}  // namespace glisson::panels
