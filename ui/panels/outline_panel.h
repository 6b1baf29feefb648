// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "panels/form.h"
#include "tools/keymap.h"

class QCheckBox;
class QLabel;
class QPushButton;
class QSlider;
class QSpinBox;
class QTreeWidget;
class QVBoxLayout;

namespace glisson::commands {
struct Outlines;
}
namespace glisson::roi {
struct Polygon;
}
namespace glisson::session {
class Session;
struct LiveStatistics;
}  // namespace glisson::session

namespace glisson::tools {
enum class ToolMode;
}

namespace glisson::panels {

class Keys;

/// Right of the images: the state of the tool, stiffness under the outline, the inner region, and the list of slices.
class OutlinePanel : public SidePanel {
  Q_OBJECT
 public:
  OutlinePanel(session::Session& session, const Keys& keys, QWidget* parent = nullptr);
  void setSlice(int slice);  ///< of the MRI; −1: no image
  void setCursorText(const QString& text);
  void setScale(double high_kPa);
  void setFusion(double opacity);  ///< of the map over the MRI, 0 ... 1
  /// Median, range and, over all slices, the mean weighted by area; empty where nothing is measured.
  static QString numbersInFull(const session::LiveStatistics& live);
  /// What an outline is: drawn, a draft, or what made it and whether it was accepted.
  static QString stateOf(const commands::Outlines& outlines, const roi::Polygon& polygon);

 signals:
  void commandWanted(glisson::tools::Command command);
  void sliceWanted(int slice);
  void importWanted();
  void scaleWanted(double high_kPa);
  void fusionWanted(double opacity);

 private:
  void makeTools(QVBoxLayout* side);
  void makeReadout(QVBoxLayout* side);
  void makeWhatIsMeasured(QVBoxLayout* side);
  void makeScale(QVBoxLayout* side);
  void makeList(QVBoxLayout* side);
  void showTool();
  static QString hintOf(tools::ToolMode mode);
  void showStatistics();
  void showOutlines();
  void showActions();
  QString whatCounts() const;
  QString readingInWords() const;
  QPushButton* commandButton(const char* name, const QString& text, const QString& icon, tools::Command command);
  session::Session& session_;
  const Keys& keys_;
  int slice_ = -1;
  QLabel *stateText_, *readout_, *pooled_, *reading_, *full_, *cursor_, *coverage_, *volume_;
  QSlider* fusion_;
  QCheckBox *inner_, *withoutVessels_;
  QSpinBox* erosion_;
  QTreeWidget* outlines_;
  QPushButton *undo_, *redo_, *accept_, *delete_, *import_, *interpolate_, *acceptAll_, *scale8_, *scale20_, *more_;
};

}  // namespace glisson::panels
