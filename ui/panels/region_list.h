// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTreeWidget>

#include "session/offered_regions.h"

namespace glisson::session {
class Session;
}

namespace glisson::panels {

/// Structures, segments, masks and contours that lie beside the images, each with a button that takes it as outlines.
class RegionList : public QTreeWidget {
  Q_OBJECT
 public:
  explicit RegionList(session::Session& session, QWidget* parent = nullptr);
  void fill();

 signals:
  void wanted(const glisson::session::OfferedRegion& region);

 private:
  session::Session& session_;
};

}  // namespace glisson::panels
