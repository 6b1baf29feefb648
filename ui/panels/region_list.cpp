// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/region_list.h"

#include <QHeaderView>
#include <algorithm>

#include "panels/form.h"
#include "session/session.h"

namespace glisson::panels {

namespace {

using Kind = session::OfferedRegion::Kind;

QString kindOf(const session::OfferedRegion& region) {
  switch (region.kind) {
    case Kind::Structure: return RegionList::tr("structure");
    case Kind::Segment: return RegionList::tr("segment");
    case Kind::Contours: return RegionList::tr("contours");
    case Kind::Mask: break;
  }
  return region.number == 0 ? RegionList::tr("mask") : RegionList::tr("mask, label %1").arg(region.number);
}

}  // namespace

RegionList::RegionList(session::Session& session, QWidget* parent) : QTreeWidget(parent), session_(session) {
  setObjectName(QStringLiteral("regionList"));
  setAccessibleName(tr("Outlines and masks beside the images"));
  setHeaderLabels({tr("Region"), tr("Kind"), tr("File"), {}});
  setRootIsDecorated(false);
  setSelectionMode(QAbstractItemView::NoSelection);
  header()->setStretchLastSection(false);
  header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  header()->setSectionResizeMode(2, QHeaderView::Stretch);
}

void RegionList::fill() {
  clear();
  const bool open = session_.images().mri != nullptr;
  for (const session::OfferedRegion& region : session_.regions()) {
    const QString file = QString::fromStdString(region.file.filename().string());
    const QString name = region.name.empty() ? tr("unnamed") : QString::fromStdString(region.name);
    auto* item = new QTreeWidgetItem(this, {name, kindOf(region), file});
    auto* take =
        button("takeRegionButton", tr("Take as outlines"), {}, tr("Takes %1 of %2 as outlines").arg(name, file));
    take->setProperty("narrow", true);
    take->setEnabled(open);
    take->ensurePolished();  // so that its size is that of its style
    item->setSizeHint(3, take->sizeHint() + QSize(12, 4));
    setItemWidget(item, 3, take);
    connect(take, &QPushButton::clicked, this, [this, region] { emit wanted(region); });
  }
  const int rows = std::min(topLevelItemCount(), 4);
  const int row = topLevelItemCount() > 0 ? topLevelItem(0)->sizeHint(3).height() : 0;
  setFixedHeight(header()->sizeHint().height() + rows * row + 8);
  setVisible(topLevelItemCount() > 0);
}

}  // namespace glisson::panels
