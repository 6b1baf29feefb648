// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>
#include <memory>
#include <optional>

#include "tools/keymap.h"
#include "tools/measure_tool.h"
#include "tools/polygon_tool.h"

class QHBoxLayout;
class QKeyEvent;
class QPushButton;
class QSpinBox;
class QSplitter;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SliceView;
}

namespace glisson::panels {

class ImageLayers;
class Keys;
class OutlinePanel;
class PlaneViews;

/// Segment: MRI and elastogram side by side with one cursor; outlines are drawn on the MRI and measured on both at
/// once.
class SegmentPage : public QWidget {
  Q_OBJECT
 public:
  SegmentPage(session::Session& session, Keys& keys, QWidget* parent = nullptr);
  views::SliceView* mriView() const { return mri_; }
  views::SliceView* mreView() const { return mre_; }
  ImageLayers* layers() const { return layers_; }
  PlaneViews* planes() const { return planes_; }
  /// The map over the MRI in all planes, 0 ... 1; 0: not seen.
  void setFusion(double opacity);
  /// One view alone, or all of them again (null).
  void fillWith(views::SliceView* view);
  /// All views show this point; kept while the mouse is elsewhere.
  void setCrosshair(const Eigen::Vector3d& p_lps);
  const tools::MeasureTool& measurements() const { return measure_; }
  bool linked() const { return linked_; }
  /// Does what a key would do.
  void run(tools::Command command);
  /// What is in the left hand: an outline tool, the ruler, or the window.
  enum class Hand { Outline, Measure, Window };
  Hand hand() const { return hand_; }

 signals:
  void importWanted();
  void helpWanted();
  void secondReaderWanted();

 private:
  // segment_page.cpp
  void makeStrip(QHBoxLayout* strip);
  void connectTool();
  void connectCursor();
  void showImages();
  void showTool();
  void showSlice();
  void linkPlace(views::SliceView* from, views::SliceView* to);
  void showCursor(const std::optional<Eigen::Vector3d>& p_lps);
  void showFirstSlice();
  // segment_planes.cpp
  void makeViews();
  void connectPlanes();
  void showPlanes(bool on);
  void showFusion();
  void keepCrosshairOnSlice();
  views::SliceView* viewUnderMouse() const;
  // segment_commands.cpp
  void keyDown(QKeyEvent* event);
  void keyUp(QKeyEvent* event);
  bool chooseWaiting();
  bool runOutline(tools::Command command);
  bool runView(tools::Command command);
  void take(Hand hand, tools::ToolMode mode);
  void nudge(const Eigen::Vector2d& pixels, int slices);
  void moveCrosshair(const Eigen::Vector2d& pixels);
  tools::Pointer atCrosshair() const;
  void clickAtCrosshair();
  void inner(int change);
  void preset(int number);
  // segment_dialogs.cpp
  void showMenu(const QPoint& at);
  void showProperties(std::size_t polygon);
  void askCopyTo();

  session::Session& session_;
  Keys& keys_;
  views::SliceView *mri_, *mre_;
  ImageLayers* layers_;
  OutlinePanel* panel_;
  PlaneViews* planes_;
  QWidget *mriColumn_ = nullptr, *mreColumn_ = nullptr;
  QSplitter *upper_ = nullptr, *all_ = nullptr;
  views::SliceView* alone_ = nullptr;  ///< the view that has the window; null: all
  double fusion_ = 0.0, lastFusion_ = 0.5;
  std::optional<Eigen::Vector3d> crosshair_;
  std::array<QPushButton*, tools::toolModeCount> modes_{};  ///< by tool mode
  QPushButton *ruler_, *window_, *link_, *planesButton_ = nullptr;
  QSpinBox* spacing_;  ///< of freehand points
  tools::MeasureTool measure_;
  Hand hand_ = Hand::Outline;
  bool linked_ = true, following_ = false;
  std::optional<Eigen::Vector3d> cursor_;
};

}  // namespace glisson::panels
