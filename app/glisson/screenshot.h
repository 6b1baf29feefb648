#pragma once

#include <QObject>
#include <QString>

#include "session/step.h"

namespace glisson::panels {
class MainWindow;
}

namespace glisson {

/// What `glisson --screenshot` does: brings the window to a step, saves a picture of it as it is on screen, and quits.
class Screenshot : public QObject {
  Q_OBJECT
 public:
  struct Wish {
    QString file;  ///< PNG to write
    session::Step step = session::Step::Load;
    QString outlines;  ///< imported after loading; empty: none
    bool run = false;
    int slice = -1;  ///< of the MRI; −1: as it opens
  };
  Screenshot(panels::MainWindow& window, Wish wish);
  /// Call once the window is shown. opening: whether a patient is being opened.
  void start(bool opening);

 private:
  void afterLoad();
  void settle();
  void take();
  panels::MainWindow& window_;
  Wish wish_;
};

}  // namespace glisson
