#pragma once

#include <QWidget>
#include <optional>

#include "tools/polygon_tool.h"

class QComboBox;
class QLabel;
class QPushButton;
class QTreeWidget;

namespace glisson::session {
class Session;
}
namespace glisson::views {
class SliceView;
}

namespace glisson::panels {

/// Segment: MRI and elastogram side by side with one cursor; outlines are drawn on the MRI and measured on both at
/// once.
class SegmentPage : public QWidget {
  Q_OBJECT
 public:
  explicit SegmentPage(session::Session& session, QWidget* parent = nullptr);
  views::SliceView* mriView() const { return mri_; }
  views::SliceView* mreView() const { return mre_; }

 signals:
  void importWanted();

 private:
  QWidget* makeSide();
  void connectTool();
  void connectCursor();
  void showImages();
  void showStatistics();
  void showOutlines();
  void showTool();
  void showActions();
  void setStiffnessScale(double high_kPa);

  session::Session& session_;
  views::SliceView* mri_;
  views::SliceView* mre_;
  QLabel* readout_;
  QLabel* pooled_;
  QLabel* cursor_;
  QLabel* stateText_;
  QLabel* coverage_;
  QTreeWidget* outlines_;
  QPushButton *undo_, *redo_, *accept_, *delete_, *import_, *interpolate_, *acceptAll_;
};

}  // namespace glisson::panels
