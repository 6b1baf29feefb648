// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <vector>

#include "session/step.h"

namespace glisson::panels {
class MainWindow;
}

namespace glisson {

/// What `glisson --screenshot` does: brings the window to a step, or to one after the other, saves a picture of it as
/// it is on screen, and quits.
class Screenshot : public QObject {
  Q_OBJECT
 public:
  struct Wish {
    QString file;  ///< PNG to write; a folder where there are several steps: load.png ... compare.png
    std::vector<session::Step> steps{session::Step::Load};
    QString outlines;  ///< imported after loading; empty: none
    bool run = false;
    int slice = -1;       ///< of the MRI; −1: as it opens
    bool planes = false;  ///< Segment: three planes, the map over the MRI
  };
  Screenshot(panels::MainWindow& window, Wish wish);
  /// Call once the window is shown. opening: whether a patient is being opened.
  void start(bool opening);

 private:
  void afterLoad();
  void whenReady();
  void settle();
  void take();
  void showPlanes();
  panels::MainWindow& window_;
  Wish wish_;
  std::size_t next_ = 0;
  bool wantsLive_ = false, wantsOverlay_ = false;  ///< still to come before the first picture
};

}  // namespace glisson
