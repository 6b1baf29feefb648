// SPDX-License-Identifier: GPL-3.0-or-later

// How a slice view draws: image, hatching, contours, cursor, letters and bars.
#include <QPainter>
#include <QPixmapCache>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "views/colour_map.h"
#include "views/line_work.h"
#include "views/slice_ink.h"
#include "views/slice_view.h"

namespace glisson::views {

namespace {

constexpr int hatchScale = 6;  // hatch pixels per voxel

/// Text that reads on bright and on dark: dark copies of it all around make its halo. Each text is drawn once and kept
/// as a picture; stroking the outlines of its glyphs would take ten times as long.
void textWithHalo(QPainter& painter, const QPointF& at, const QString& text, const QColor& colour) {
  const double ratio = painter.device()->devicePixelRatioF();
  const QString key = QStringLiteral("halo|%1|%2|%3|%4").arg(text, painter.font().key(), colour.name()).arg(ratio);
  const QFontMetricsF metrics(painter.font());
  constexpr double margin = 4.0, halo_px = 1.5;
  constexpr int copies = 12;
  QPixmap picture;
  if (!QPixmapCache::find(key, &picture)) {
    const QSizeF size(metrics.horizontalAdvance(text) + 2.0 * margin, metrics.height() + 2.0 * margin);
    picture = QPixmap((size * ratio).toSize());
    picture.setDevicePixelRatio(ratio);
    picture.fill(Qt::transparent);
    QPainter on(&picture);
    on.setFont(painter.font());
    const QPointF origin(margin, margin + metrics.ascent());
    on.setPen(Qt::black);
    for (int i = 0; i < copies; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / copies;
      on.drawText(origin + halo_px * QPointF(std::cos(angle), std::sin(angle)), text);
    }
    on.setCompositionMode(QPainter::CompositionMode_DestinationIn);
    on.fillRect(QRectF(QPointF(), size), QColor(0, 0, 0, 170));
    on.setCompositionMode(QPainter::CompositionMode_SourceOver);
    on.setPen(colour);
    on.drawText(origin, text);
    on.end();
    QPixmapCache::insert(key, picture);
  }
  painter.drawPixmap(at - QPointF(margin, margin + metrics.ascent()), picture);
}

QString letterOf(const Eigen::Vector3d& direction) {
  static const std::array<std::array<const char*, 2>, 3> letters = {{{"R", "L"}, {"A", "P"}, {"I", "S"}}};
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return QString::fromLatin1(letters[static_cast<std::size_t>(axis)][direction[axis] > 0.0 ? 1 : 0]);
}

}  // namespace

void SliceView::renderSlice() {
  stale_ = false;
  const image::Grid& grid = volume_.values->grid;
  const int nx = grid.size.x(), ny = grid.size.y();
  image_ = QImage(nx, ny, QImage::Format_RGB32);
  const auto& colours = volume_.stiffness ? stiffnessColours() : volume_.wave ? waveColours() : greyLevels();
  const double scale = 255.0 / (volume_.high - volume_.low);
  for (int j = 0; j < ny; ++j) {
    auto* line = reinterpret_cast<QRgb*>(image_.scanLine(j));
    const float* values = &volume_.values->values[grid.linear(0, j, slice_)];
    for (int i = 0; i < nx; ++i) {
      // No stiffness at all is no colour of the scale: it stays dark.
      if (volume_.stiffness && !(values[i] > 0.0F)) {
        line[i] = paper.rgb();
        continue;
      }
      const double level = (static_cast<double>(values[i]) - volume_.low) * scale;
      line[i] = colours[static_cast<std::size_t>(std::isfinite(level) ? std::clamp(level, 0.0, 255.0) : 0.0)];
    }
  }
  fuse();
  hatch_ = QImage();
  if (!volume_.confidence || !volume_.confidence->grid.sameGeometry(grid)) return;
  hatch_ = QImage(nx * hatchScale, ny * hatchScale, QImage::Format_ARGB32_Premultiplied);
  hatch_.fill(Qt::transparent);
  const QRgb shade = qPremultiply(qRgba(8, 10, 14, 120)), stripe = qPremultiply(qRgba(235, 238, 245, 120));
  for (int j = 0; j < ny; ++j) {
    const float* confidence = &volume_.confidence->values[grid.linear(0, j, slice_)];
    const float* values = &volume_.values->values[grid.linear(0, j, slice_)];
    for (int i = 0; i < nx; ++i) {
      if (!(values[i] > 0.0F)) continue;
      if (static_cast<double>(confidence[i]) >= volume_.confidenceThreshold) continue;
      for (int y = j * hatchScale; y < (j + 1) * hatchScale; ++y) {
        auto* line = reinterpret_cast<QRgb*>(hatch_.scanLine(y));
        for (int x = i * hatchScale; x < (i + 1) * hatchScale; ++x) line[x] = (x + y) % 24 < 3 ? stripe : shade;
      }
    }
  }
}

void SliceView::renderBackdrop() {
  const tools::SlicePlane shown = plane();
  const Place place{zoom_px_mm_, offset_px_.x(), offset_px_.y(), devicePixelRatioF(), hidden_};
  const QSize size = (QSizeF(this->size()) * devicePixelRatioF()).toSize();
  const bool fresh = stale_ || backdrop_.size() != size || !(place == shownPlace_);
  if (!fresh) return;
  if (stale_) renderSlice();
  shownPlace_ = place;
  if (backdrop_.size() != size) backdrop_ = QImage(size, QImage::Format_RGB32);
  backdrop_.setDevicePixelRatio(devicePixelRatioF());
  backdrop_.fill(paper);
  QPainter painter(&backdrop_);
  const image::Grid& grid = shown.grid;
  painter.setRenderHint(QPainter::SmoothPixmapTransform, !volume_.stiffness);
  painter.translate(point(shown.offset_px));
  painter.scale(shown.scale_px_mm.x() * grid.spacing_mm.x(), shown.scale_px_mm.y() * grid.spacing_mm.y());
  const QRectF cells(-0.5, -0.5, grid.size.x(), grid.size.y());
  painter.drawImage(cells, image_);
  if (hatch_.isNull() || hidden_) return;
  painter.setRenderHint(QPainter::SmoothPixmapTransform, true);
  painter.drawImage(cells, hatch_);
}

void SliceView::paintContours(QPainter& painter) const {
  if (hidden_) return;
  const tools::SlicePlane shown = plane();
  if (!contours_) {
    paintExtras(painter, shown);
    return;
  }
  // Thick slices hold several drawn planes: where nothing is edited only those nearest to the middle are shown.
  const auto offPlane_mm = [&shown](const roi::Polygon& polygon) {
    const Eigen::Vector3d index = shown.grid.lpsToIndex(polygon.points_lps_mm.rowwise().mean());
    return std::abs(index.z() - shown.slice) * shown.grid.spacing_mm.z();
  };
  double nearest_mm = 0.5 * shown.grid.spacing_mm.z();
  for (const roi::Polygon& polygon : contours_->polygons)
    if (!tool_ && shown.holds(polygon)) nearest_mm = std::min(nearest_mm, offPlane_mm(polygon));
  const std::optional<tools::Hit> hover = tool_ ? tool_->hover() : std::nullopt;
  LineWork lines(rect());
  QList<std::pair<QPointF, std::pair<QColor, bool>>> handles;
  for (std::size_t p = 0; p < contours_->polygons.size(); ++p) {
    const roi::Polygon& polygon = contours_->polygons[p];
    if (!shown.holds(polygon)) continue;
    if (!tool_ && offPlane_mm(polygon) > nearest_mm + 0.1) continue;
    const bool selected = tool_ && tool_->selected() == p;
    const bool moving = selected && tool_->preview().cols() > 0;
    const QPolygonF outline = toScreen(moving ? tool_->preview() : polygon.points_lps_mm, shown);
    const bool accepted = polygon.state == roi::PolygonState::Accepted;
    const bool crossing = moving ? tool_->crosses() : judged_[p].crosses;
    // Interpolated outlines count like accepted ones: their colour, but dashed until somebody has looked at them.
    const bool draft = polygon.state == roi::PolygonState::Draft;
    const QColor colour = crossing          ? crossingColour
                          : polygon.exclude ? excludedColour
                          : draft           ? draftColour
                                            : acceptedColour;
    if (selected) {
      QColor wash = colour;
      wash.setAlpha(28);
      painter.setPen(Qt::NoPen);
      painter.setBrush(wash);
      painter.drawPolygon(outline);
    }
    const bool hovered = hover && hover->polygon == p && hover->kind != tools::Hit::Kind::Inside;
    lines.add(outline, true, colour, selected || hovered ? 2.0 : 1.5, !accepted || crossing);
    if (!selected && !hovered) continue;
    for (int v = 0; v < outline.size(); ++v) {
      const auto& chosen = tool_->selectedVertices();
      const bool strong =
          (selected && std::find(chosen.begin(), chosen.end(), v) != chosen.end()) ||
          (hover && hover->polygon == p && hover->kind == tools::Hit::Kind::Vertex && hover->vertex == v);
      handles.append({outline[v], {colour, strong}});
    }
  }
  lines.paint(painter);
  for (const auto& [at, look] : handles) drawHandle(painter, at, look.first, look.second);
  paintExtras(painter, shown);
  if (tool_) paintOutlineInWork(painter, shown);
}

std::optional<QPointF> SliceView::seenAt(const Eigen::Vector3d& p_lps) const {
  if (!hasVolume()) return {};
  const image::Grid& grid = volume_.values->grid;
  const double off_mm = std::abs(grid.lpsToIndex(p_lps).z() - slice_) * grid.spacing_mm.z();
  if (off_mm > std::max(0.75 * grid.spacing_mm.z(), 6.0)) return {};
  return point(plane().toPixel(p_lps));
}

// A second reader, the inner region, distances, and the disc of the tool in hand.
void SliceView::paintExtras(QPainter& painter, const tools::SlicePlane& shown) const {
  LineWork lines(rect());
  if (second_)
    for (const roi::Polygon& polygon : second_->polygons)
      if (shown.holds(polygon)) lines.add(toScreen(polygon.points_lps_mm, shown), true, secondColour, 1.4, true);
  if (inner_ && inner_->grid.sameGeometry(shown.grid)) {
    const auto corner = [&](double i, double j) {
      return point(shown.toPixel(shown.grid.indexToLps({i, j, 1.0 * slice_})));
    };
    const auto in = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < shown.grid.size.x() && j < shown.grid.size.y() && inner_->at(i, j, slice_) != 0;
    };
    for (int j = 0; j <= shown.grid.size.y(); ++j)
      for (int i = 0; i <= shown.grid.size.x(); ++i) {
        const QPointF here = corner(i - 0.5, j - 0.5);
        if (in(i, j) != in(i - 1, j)) lines.add({{here, corner(i - 0.5, j + 0.5)}}, false, ink, 1.2);
        if (in(i, j) != in(i, j - 1)) lines.add({{here, corner(i + 0.5, j - 0.5)}}, false, ink, 1.2);
      }
  }
  const auto seen = [&](const Eigen::Vector2d& pixel) {
    return point(shown.toPixel(shown.grid.indexToLps({pixel.x(), pixel.y(), 1.0 * slice_})));
  };
  for (const tools::BorderEdge& edge : cut_) lines.add({{seen(edge.from), seen(edge.to)}}, false, acceptedColour, 1.5);
  lines.paint(painter);
  if (measurements_) {
    const auto draw = [&](const tools::Distance& d) {
      const double k = shown.grid.lpsToIndex(d.from_lps_mm).z();
      if (std::lround(k) != slice_) return;
      const QPointF a = point(shown.toPixel(d.from_lps_mm)), b = point(shown.toPixel(d.to_lps_mm));
      LineWork line(rect());
      line.add({{a, b}}, false, measureColour, 1.6);
      line.paint(painter);
      for (const QPointF& end : {a, b}) drawHandle(painter, end, measureColour, false);
      textWithHalo(painter, (a + b) / 2.0 + QPointF(8.0, -8.0), QString::number(d.length_mm(), 'f', 1) + tr(" mm"),
                   measureColour);
    };
    for (const tools::Distance& d : measurements_->distances()) draw(d);
    if (measurements_->inWork()) draw(*measurements_->inWork());
  }
  if (tool_ && tool_->brush()) {
    painter.setPen(QPen(ink, 1.2, Qt::DashLine));
    painter.setBrush(QColor(255, 255, 255, 20));
    painter.drawEllipse(point(shown.toPixel(*tool_->brush())), tool_->brushRadius(), tool_->brushRadius());
  }
}

void SliceView::paintCursor(QPainter& painter) const {
  if (!cursor_ || (underMouse() && !byKeys_)) return;
  const QPointF at = point(plane().toPixel(*cursor_));
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setPen(QPen(QColor(120, 220, 160, byKeys_ ? 240 : 170), 1.0));
  painter.drawLine(QPointF(at.x(), 0), QPointF(at.x(), at.y() - 8));
  painter.drawLine(QPointF(at.x(), at.y() + 8), QPointF(at.x(), height()));
  painter.drawLine(QPointF(0, at.y()), QPointF(at.x() - 8, at.y()));
  painter.drawLine(QPointF(at.x() + 8, at.y()), QPointF(width(), at.y()));
  painter.setRenderHint(QPainter::Antialiasing, true);
}

void SliceView::paintColourBar(QPainter& painter) const {
  if (!volume_.stiffness) return;
  const double barHeight = std::min(height() * 0.6, 340.0);
  const QRectF bar(width() - 58.0, (height() - barHeight) / 2.0, 13.0, barHeight);
  const auto& colours = stiffnessColours();
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  for (std::size_t i = 0; i < colours.size(); i += 15)
    gradient.setColorAt(static_cast<double>(i) / 255.0, QColor(colours[i]));
  painter.setPen(QPen(QColor(255, 255, 255, 90), 1.0));
  painter.setBrush(gradient);
  painter.drawRect(bar);
  const double range = volume_.high - volume_.low;
  for (int tick = 0; tick <= 4; ++tick) {
    const double y = bar.bottom() - bar.height() * tick / 4.0;
    painter.setPen(QPen(ink, 1.0));
    painter.drawLine(QPointF(bar.right(), y), QPointF(bar.right() + 4.0, y));
    textWithHalo(painter, QPointF(bar.right() + 8.0, y + 4.0),
                 QString::number(volume_.low + range * tick / 4.0, 'g', 3), ink);
  }
  textWithHalo(painter, QPointF(bar.left() - 4.0, bar.top() - 12.0), volume_.unit, ink);
}

void SliceView::paintScaleBar(QPainter& painter) const {
  double length_mm = 100.0;
  while (length_mm * zoom_px_mm_ > 0.3 * width() && length_mm > 1.0)
    length_mm /= length_mm == 50.0 || length_mm == 5.0 ? 2.5 : 2.0;
  const double length_px = length_mm * zoom_px_mm_;
  const QPointF right(width() - (volume_.stiffness ? 84.0 : 16.0), height() - 16.0);
  const QPointF left = right - QPointF(length_px, 0.0), up(0.0, -5.0);
  LineWork bar(QRectF(left + up, right));
  bar.add({{left + up, left, right, right + up}}, false, ink, 1.5);
  bar.paint(painter);
  const QString text = QString::number(length_mm) + QStringLiteral(" mm");
  const double w = painter.fontMetrics().horizontalAdvance(text);
  textWithHalo(painter, right - QPointF((length_px + w) / 2.0, 8.0), text, ink);
}

void SliceView::paintLabels(QPainter& painter) const {
  const tools::SlicePlane shown = plane();
  QFont font = painter.font();
  font.setBold(true);
  painter.setFont(font);
  textWithHalo(painter, {14.0, 24.0}, volume_.title, ink);
  const Eigen::Vector3d right = shown.grid.direction.col(0) * (shown.scale_px_mm.x() > 0 ? 1.0 : -1.0);
  const Eigen::Vector3d down = shown.grid.direction.col(1) * (shown.scale_px_mm.y() > 0 ? 1.0 : -1.0);
  const double rightEdge = width() - (volume_.stiffness ? 84.0 : 20.0);
  textWithHalo(painter, {12.0, height() / 2.0}, letterOf(-right), faint);
  textWithHalo(painter, {rightEdge, height() / 2.0}, letterOf(right), faint);
  textWithHalo(painter, {width() / 2.0, 24.0}, letterOf(-down), faint);
  textWithHalo(painter, {width() / 2.0, height() - 14.0}, letterOf(down), faint);
  font.setBold(false);
  painter.setFont(font);
  QString where = tr("slice %1 / %2").arg(slice_ + 1).arg(sliceCount());
  textWithHalo(painter, {14.0, 43.0}, where, faint);
  if (!note_.isEmpty()) textWithHalo(painter, {14.0, 62.0}, note_, excludedColour);
  if (cursor_) {
    QStringList values;
    if (const std::optional<double> value = valueAt(*cursor_))
      values << QString::number(*value, 'f', volume_.stiffness || volume_.high - volume_.low < 20.0 ? 2 : 0) +
                    QLatin1Char(' ') + volume_.unit;
    if (const std::optional<double> laid = fusedAt(*cursor_)) values << QString::number(*laid, 'f', 2) + tr(" kPa");
    if (!values.isEmpty()) textWithHalo(painter, {14.0, height() - 16.0}, values.join(QStringLiteral("   ")), ink);
  }
}

void SliceView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), paper);
  painter.setRenderHint(QPainter::Antialiasing);
  if (!hasVolume()) {
    painter.setPen(faint);
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, hint_);
    return;
  }
  renderBackdrop();
  judgeCrossings();
  painter.drawImage(QPointF(0.0, 0.0), backdrop_);
  paintContours(painter);
  paintMarks(painter, marks_, [this](const Eigen::Vector3d& p) { return seenAt(p); });
  paintCursor(painter);
  paintColourBar(painter);
  paintScaleBar(painter);
  paintLabels(painter);
  if (hasFocus()) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(QColor(90, 160, 255, 150), 1.0));
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
  }
}

}  // namespace glisson::views
