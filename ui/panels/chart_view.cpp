// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/chart_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <utility>

namespace glisson::panels {

ChartView::ChartView(QWidget* parent) : QWidget(parent) {
  setMinimumSize(320, 220);
}

void ChartView::setChart(Chart chart) {
  chart_ = std::move(chart);
  draw();
}

void ChartView::setHint(const QString& hint) {
  chart_.reset();
  image_ = QImage();
  hint_ = hint;
  update();
}

render::ChartSize ChartView::size_() const {
  const double ratio = devicePixelRatioF();
  return {std::max(200, static_cast<int>(width() * ratio)), std::max(160, static_cast<int>(height() * ratio))};
}

void ChartView::draw() {
  if (!chart_) return;
  if (worker_.busy()) {
    wanted_ = true;
    return;
  }
  auto drawn = std::make_shared<render::Picture>();
  worker_.start(
      [drawn, chart = *chart_, size = size_()](const Progress&) {
        *drawn = std::visit([&size](const auto& c) { return render::draw(c, size); }, chart);
      },
      [this, drawn](std::exception_ptr failure) {
        if (failure) {
          setHint(session::reasonOf(failure));
        } else if (chart_) {
          const QImage view(drawn->rgb.data(), drawn->width, drawn->height, 3 * drawn->width, QImage::Format_RGB888);
          image_ = view.convertToFormat(QImage::Format_RGB32);
          update();
        }
        if (std::exchange(wanted_, false)) draw();
      });
}

void ChartView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (!image_.isNull()) {
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(QRectF(rect()), image_);
    return;
  }
  painter.fillRect(rect(), palette().base());
  painter.setPen(palette().color(QPalette::PlaceholderText));
  painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, hint_);
}

void ChartView::resizeEvent(QResizeEvent*) {
  draw();
}

void ChartView::clicked(const QPointF& at, bool twice) {
  if (!chart_ || image_.isNull()) return;
  const render::ChartSize size = size_();
  const render::Point pixel(at.x() * size.width / width(), at.y() * size.height / height());
  if (const auto* histogram = std::get_if<render::Histogram>(&*chart_)) {
    if (const auto column = render::columnAt(*histogram, pixel, size))
      emit columnClicked(column->low, column->high, twice);
  } else if (const auto place = render::placeAt(std::get<render::BoxPlot>(*chart_), pixel, size)) {
    emit placeClicked(place->box, place->value, twice);
  }
}

void ChartView::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) clicked(event->position(), false);
}

void ChartView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) clicked(event->position(), true);
}

}  // namespace glisson::panels
