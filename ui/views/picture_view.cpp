// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/picture_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace glisson::views {

void greyOut(QPainter& painter, const QRect& place, const QString& words) {
  painter.save();
  painter.fillRect(place, QColor(16, 18, 22, 130));
  QFont bold = painter.font();
  bold.setBold(true);
  painter.setFont(bold);
  const QRect text =
      painter.fontMetrics().boundingRect(place.adjusted(16, 0, -16, 0), Qt::AlignHCenter | Qt::TextWordWrap, words);
  const QRect band(place.left(), place.top(), place.width(), text.height() + 16);
  painter.fillRect(band, QColor(0xf0, 0xb4, 0x4a));
  painter.setPen(QColor(16, 18, 22));
  painter.drawText(band.adjusted(16, 8, -16, -8), Qt::AlignCenter | Qt::TextWordWrap, words);
  painter.restore();
}

PictureView::PictureView(QWidget* parent) : QWidget(parent) {
  setMinimumSize(240, 240);
  setFocusPolicy(Qt::StrongFocus);
}

void PictureView::setPicture(const render::Picture& picture) {
  const QImage view(picture.rgb.data(), picture.width, picture.height, 3 * picture.width, QImage::Format_RGB888);
  const bool sameSize = view.size() == image_.size();
  image_ = view.convertToFormat(QImage::Format_RGB32);
  if (!sameSize) fit();
  update();
}

void PictureView::clear() {
  image_ = QImage();
  update();
}

void PictureView::setHint(const QString& hint) {
  hint_ = hint;
  update();
}

void PictureView::setOutdated(const QString& words) {
  if (words == outdated_) return;
  outdated_ = words;
  update();
}

void PictureView::fit() {
  fitted_ = true;
  if (image_.isNull()) return;
  zoom_ = std::min(static_cast<double>(width()) / image_.width(), static_cast<double>(height()) / image_.height());
  offset_ = QPointF((width() - zoom_ * image_.width()) / 2.0, (height() - zoom_ * image_.height()) / 2.0);
  update();
}

void PictureView::zoomAt(const QPointF& at, double factor) {
  const double wanted = std::clamp(zoom_ * factor, 0.05, 40.0);
  offset_ = at + (offset_ - at) * (wanted / zoom_);
  zoom_ = wanted;
  fitted_ = false;
  update();
}

void PictureView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), QColor(16, 18, 22));
  if (image_.isNull()) {
    painter.setPen(QColor(148, 160, 176));
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, hint_);
    return;
  }
  painter.save();
  drawImage(painter);
  painter.restore();
  if (!outdated_.isEmpty()) greyOut(painter, rect(), outdated_);
}

void PictureView::drawImage(QPainter& painter) const {
  painter.setRenderHint(QPainter::SmoothPixmapTransform, zoom_ < 3.0);
  painter.translate(offset_);
  if (zoom_ < 0.6) {
    // Halving first keeps thin grid lines when a large picture is shown small.
    const QSize size = image_.size() * (zoom_ * devicePixelRatioF());
    painter.scale(1.0 / devicePixelRatioF(), 1.0 / devicePixelRatioF());
    painter.drawImage(QPointF(0, 0), image_.scaled(size, Qt::KeepAspectRatio, Qt::SmoothTransformation));
    return;
  }
  painter.scale(zoom_, zoom_);
  painter.drawImage(QPointF(0, 0), image_);
}

void PictureView::resizeEvent(QResizeEvent*) {
  if (fitted_) fit();
  emit resized();
}

void PictureView::wheelEvent(QWheelEvent* event) {
  if (image_.isNull() || event->angleDelta().y() == 0) return;
  const bool up = event->angleDelta().y() > 0;
  if (event->modifiers().testFlag(Qt::ControlModifier))
    zoomAt(event->position(), up ? 1.15 : 1.0 / 1.15);
  else
    emit sliceWanted(up ? 1 : -1);
  event->accept();
}

void PictureView::keyPressEvent(QKeyEvent* event) {
  const QPointF middle(0.5 * width(), 0.5 * height());
  switch (image_.isNull() ? Qt::Key_unknown : static_cast<Qt::Key>(event->key())) {
    case Qt::Key_Up: emit sliceWanted(1); return;
    case Qt::Key_Down: emit sliceWanted(-1); return;
    case Qt::Key_Plus:
    case Qt::Key_Equal: zoomAt(middle, 1.15); return;
    case Qt::Key_Minus: zoomAt(middle, 1.0 / 1.15); return;
    case Qt::Key_Home: fit(); return;
    default: QWidget::keyPressEvent(event);
  }
}

void PictureView::mousePressEvent(QMouseEvent* event) {
  button_ = event->button();
  pressed_ = last_ = event->position();
}

void PictureView::mouseMoveEvent(QMouseEvent* event) {
  if (button_ == Qt::NoButton || image_.isNull()) return;
  const QPointF step = event->position() - last_;
  last_ = event->position();
  if (button_ == Qt::RightButton) {
    zoomAt(pressed_, std::exp(-step.y() * 0.01));
  } else {
    offset_ += step;
    fitted_ = false;
    update();
  }
}

void PictureView::mouseReleaseEvent(QMouseEvent*) {
  button_ = Qt::NoButton;
}

void PictureView::mouseDoubleClickEvent(QMouseEvent*) {
  fit();
}

}  // namespace glisson::views
