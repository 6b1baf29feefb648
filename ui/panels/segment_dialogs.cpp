// SPDX-License-Identifier: GPL-3.0-or-later

// The menu over an outline, its properties, and copying to other slices.
#include <QInputDialog>
#include <QMenu>

#include "base/error.h"
#include "panels/keys.h"
#include "panels/outline_panel.h"
#include "panels/segment_page.h"
#include "roi/contour_stack.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

using tools::Command;

void SegmentPage::showMenu(const QPoint& at) {
  auto* popup = new QMenu(this);
  popup->setAttribute(Qt::WA_DeleteOnClose);
  QMenu& menu = *popup;
  menu.setObjectName(QStringLiteral("outlineMenu"));
  const bool selected = session_.tool().selected().has_value();
  const auto add = [&](Command command, bool enabled) {
    QAction* action = menu.addAction(nameOf(command) + QLatin1Char('\t') + keys_.text(command));
    action->setEnabled(enabled);
    connect(action, &QAction::triggered, this, [this, command] { run(command); });
  };
  add(Command::CloseOrAccept, session_.tool().state() == tools::ToolState::Editing);
  add(Command::Delete, selected);
  add(Command::Split, selected);
  add(Command::Trim, selected);
  menu.addSeparator();
  add(Command::Unite, selected);
  add(Command::Subtract, selected);
  add(Command::Intersect, selected);
  menu.addSeparator();
  add(Command::Include, selected);
  add(Command::Exclude, selected);
  menu.addSeparator();
  add(Command::Copy, true);
  add(Command::Paste, session_.canPaste());
  add(Command::PasteBetween, session_.canPaste());
  QAction* copyTo = menu.addAction(tr("Copy to slices…"));
  copyTo->setObjectName(QStringLiteral("copyToSlices"));
  connect(copyTo, &QAction::triggered, this, &SegmentPage::askCopyTo);
  menu.addSeparator();
  add(Command::Propose, true);
  add(Command::MarkNoLiver, true);
  add(Command::MarkNoWave, true);
  if (selected) {
    menu.addSeparator();
    const std::size_t polygon = *session_.tool().selected();
    connect(menu.addAction(tr("Properties and statistics…")), &QAction::triggered, this,
            [this, polygon] { showProperties(polygon); });
  }
  menu.popup(at);
}

void SegmentPage::askCopyTo() {
  auto* dialog = new QInputDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Copy to slices"));
  dialog->setLabelText(tr("Copy to all empty slices up to slice:"));
  dialog->setInputMode(QInputDialog::IntInput);
  dialog->setIntRange(1, mri_->sliceCount());
  dialog->setIntValue(mri_->slice() + 1);
  connect(dialog, &QInputDialog::intValueSelected, this, [this](int last) {
    session_.copyOutlines();
    session_.pasteTo(std::min(last - 1, mri_->slice()), std::max(last - 1, mri_->slice()));
  });
  dialog->open();
}

void SegmentPage::showProperties(std::size_t index) {
  if (index >= session_.contours().polygons.size()) return;
  const roi::Polygon& polygon = session_.contours().polygons[index];
  roi::ContourStack alone;
  alone.polygons = {polygon};
  alone.polygons.front().state = roi::PolygonState::Accepted;
  alone.polygons.front().exclude = false;
  QString area = tr("none");
  try {
    area = tr("%1 cm²").arg(roi::area_mm2(alone) / 100.0, 0, 'f', 2);
  } catch (const Error& e) {
    area = QString::fromUtf8(e.what());
  }
  const auto& live = session_.statistics();
  QString stiffness = live.reason;
  if (live.slice)
    stiffness = tr("%1 ± %2 kPa (µ), %3 of %4 pixels count")
                    .arg(live.slice->mean_kPa, 0, 'f', 2)
                    .arg(live.slice->sd_kPa, 0, 'f', 2)
                    .arg(live.slice->n)
                    .arg(live.slice->n_before_mask);
  if (const QString full = OutlinePanel::numbersInFull(live); !full.isEmpty()) stiffness += QLatin1Char('\n') + full;
  const QString state = polygon.exclude ? tr("left out") : OutlinePanel::stateOf(session_.contours(), polygon);
  auto* dialog = new QInputDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setObjectName(QStringLiteral("outlineProperties"));
  dialog->setWindowTitle(tr("Outline on slice %1").arg(mri_->slice() + 1));
  dialog->setLabelText(tr("%1 vertices, %2\nArea: %3\nStiffness on this slice: %4\n\nName of the region:")
                           .arg(polygon.points_lps_mm.cols())
                           .arg(state, area, stiffness));
  dialog->setTextValue(QString::fromStdString(session_.contours().name));
  connect(dialog, &QInputDialog::textValueSelected, &session_, &session::Session::rename);
  dialog->open();
}

}  // namespace glisson::panels
