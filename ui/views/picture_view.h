// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>

#include "render/overlay.h"

class QPainter;

namespace glisson::views {

/// Greys what is drawn at the place and says in a band at its top why it is not of what is set now.
void greyOut(QPainter& painter, const QRect& place, const QString& words);

/// A finished picture, fitted to the widget; wheel with Ctrl, or right drag, zooms; middle or left drag moves;
/// double-click fits. The plain wheel is passed on as a request for another slice. Keys: up and down ask for another
/// slice, + and - zoom, Home fits.
class PictureView : public QWidget {
  Q_OBJECT
 public:
  explicit PictureView(QWidget* parent = nullptr);

  /// The place and zoom are kept while pictures of one size follow each other.
  void setPicture(const render::Picture& picture);
  void clear();
  void setHint(const QString& hint);  ///< shown while there is no picture
  /// Words across the top of a picture that is no longer of what is set: it is greyed. Empty: it is.
  void setOutdated(const QString& words);
  bool hasPicture() const { return !image_.isNull(); }
  const QImage& picture() const { return image_; }
  void fit();

 signals:
  void resized();
  void sliceWanted(int step);  ///< +1 or −1

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  void drawImage(QPainter& painter) const;
  void zoomAt(const QPointF& at, double factor);
  QImage image_;
  QString hint_, outdated_;
  double zoom_ = 1.0;
  QPointF offset_;
  bool fitted_ = true;
  QPointF pressed_, last_;
  Qt::MouseButton button_ = Qt::NoButton;
};

}  // namespace glisson::views
