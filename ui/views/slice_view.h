// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <QImage>
#include <QWidget>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/volume.h"
#include "roi/contour_stack.h"
#include "tools/measure_tool.h"
#include "tools/polygon_tool.h"
#include "tools/region_cut.h"
#include "tools/slice_plane.h"
#include "views/marks.h"

namespace glisson::views {

/// What a slice view shows.
struct ShownVolume {
  std::shared_ptr<const image::ScalarVolume> values;
  std::shared_ptr<const image::ScalarVolume> confidence;  ///< same grid; hatched below the threshold; may be null
  double confidenceThreshold = 0.95;                      ///< of 1
  bool stiffness = false;                                 ///< colour scale with a bar; else grey levels
  bool wave = false;                                      ///< blue, white, red around 0
  double low = 0.0, high = 1.0;                           ///< window
  QString title;                                          ///< "MRI", "MRE stiffness": never patient text
  QString unit;                                           ///< of the value under the cursor
  std::vector<std::string> sopInstanceUids;               ///< per slice; may be empty
};

/// A stiffness map laid over a slice in its colours, by position in the patient: on any grid.
struct Fusion {
  std::shared_ptr<const image::ScalarVolume> values;  ///< kPa; what is not above 0 is left out; null: nothing is laid
  double high_kPa = 8.0;                              ///< end of the colour scale, which begins at 0
  double opacity = 0.0;                               ///< 0 ... 1
  bool operator==(const Fusion&) const = default;
};

/// One slice of a volume with contours, cursor and readouts. Wheel: slice; Ctrl+wheel or right drag: zoom; middle drag
/// or Space+drag: pan; Alt+drag: window and level (not of stiffness; of a wave the width alone). The left button and
/// keys are passed on to whoever holds the tool, with every other key.
class SliceView : public QWidget {
  Q_OBJECT
 public:
  explicit SliceView(QWidget* parent = nullptr);

  void setVolume(ShownVolume volume);
  void clear() { setVolume({}); }
  bool hasVolume() const { return volume_.values != nullptr; }
  const ShownVolume& volume() const { return volume_; }

  /// contours: drawn where they belong to the slice shown. tool: what is in work; null in a view that only shows.
  /// Both must outlive the view or be set to null.
  void setContours(const roi::ContourStack* contours, const tools::PolygonTool* tool);

  /// What lies over the image beside the outlines; null = nothing. All must outlive the view or be set to null.
  void setMeasurements(const tools::MeasureTool* measurements) { measurements_ = measurements, update(); }
  void setSecondReader(const roi::ContourStack* contours) { second_ = contours, update(); }
  /// Border of an inner region, on the grid of the volume; else it is not drawn.
  void setInner(std::shared_ptr<const image::Mask> inner) { inner_ = std::move(inner), update(); }
  void setFusion(const Fusion& fusion);
  const Fusion& fusion() const { return fusion_; }
  /// A region on any grid, of which the cut with the slice is shown: what counts, in planes across those drawn on.
  void setRegion(std::shared_ptr<const image::Mask> region);
  const std::vector<tools::BorderEdge>& regionCut() const { return cut_; }
  void setNote(const QString& note);  ///< a few words under the slice number: a mark of the slice
  /// Places that lie on the slice shown, or nearly; whoever sets them handles the tool's signals.
  void setMarks(std::vector<Mark> marks) { marks_ = std::move(marks), update(); }
  const std::vector<Mark>& marks() const { return marks_; }
  std::optional<QPointF> seenAt(const Eigen::Vector3d& p_lps) const;
  void setOverlaysHidden(bool hidden) { hidden_ = hidden, update(); }
  /// The left button changes the window instead of going to the tool.
  void setLeftDragWindows(bool on) { leftWindows_ = on; }
  /// The right button changes the window instead of zooming (not of stiffness). A right click stays one.
  void setRightDragWindows(bool on) { rightWindows_ = on; }

  int slice() const { return slice_; }
  int sliceCount() const { return volume_.values ? volume_.values->grid.size.z() : 0; }
  void setSlice(int slice);
  void showPoint(const Eigen::Vector3d& p_lps);  ///< goes to the slice nearest to the point
  void setCursor(std::optional<Eigen::Vector3d> p_lps);
  /// The cursor is moved by keys: it is shown though the mouse is over the view, until the mouse moves.
  void setCursorByKeys() { byKeys_ = true, update(); }
  bool cursorByKeys() const { return byKeys_; }
  void setWindow(double low, double high);
  void fit();
  /// Shows the same place at the same scale as another view does.
  void showPlace(const Eigen::Vector3d& centre_lps, double zoom_px_mm);
  Eigen::Vector3d centre_lps() const;
  double zoom_px_mm() const { return zoom_px_mm_; }
  void setHint(const QString& hint);  ///< shown in the middle while there is no volume

  /// The map between this view and the patient. Valid while hasVolume().
  tools::SlicePlane plane() const;
  /// Value of the voxel under a point, where it lies in the volume.
  std::optional<double> valueAt(const Eigen::Vector3d& p_lps) const;
  /// The same of the map that is laid over it, where one is seen; kPa.
  std::optional<double> fusedAt(const Eigen::Vector3d& p_lps) const;

 signals:
  void sliceAboutToChange();
  void sliceChanged(int slice);
  void cursorMoved(const Eigen::Vector3d& p_lps);
  void cursorLeft();
  void windowChanged(double low, double high);
  void windowRefused();  ///< by hand: colours of the stiffness mean the same numbers always
  void toolPressed(const glisson::tools::Pointer& at);
  void toolMoved(const glisson::tools::Pointer& at);
  void toolReleased(const glisson::tools::Pointer& at);
  void toolDoubleClicked(const glisson::tools::Pointer& at);
  void toolRightClicked(const glisson::tools::Pointer& at);
  void placeChanged();  ///< zoomed or panned by hand
  void resettled();     ///< fitted anew, or the view has another size
  void keyDown(QKeyEvent* event);
  void keyUp(QKeyEvent* event);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void enterEvent(QEnterEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  enum class Drag { None, Tool, Zoom, Pan, Window };
  void zoomAt(const QPointF& at, double factor);
  void renderSlice();
  Eigen::Vector2d axisSigns() const;
  void renderBackdrop();
  void paintContours(QPainter& painter) const;
  void paintOutlineInWork(QPainter& painter, const tools::SlicePlane& plane) const;
  void paintShape(QPainter& painter, const tools::SlicePlane& shown) const;
  void paintCursor(QPainter& painter) const;
  void paintExtras(QPainter& painter, const tools::SlicePlane& plane) const;
  void paintLabels(QPainter& painter) const;
  void paintColourBar(QPainter& painter) const;
  void paintScaleBar(QPainter& painter) const;
  QRectF imageArea() const;
  void judgeCrossings();
  void fuse();
  void cutRegion();

  ShownVolume volume_;
  Fusion fusion_;
  std::shared_ptr<const image::Mask> region_;
  std::vector<tools::BorderEdge> cut_;  ///< of the region with the slice shown
  const roi::ContourStack* contours_ = nullptr;
  const tools::PolygonTool* tool_ = nullptr;
  int slice_ = 0;
  double zoom_px_mm_ = 1.0;
  Eigen::Vector2d offset_px_ = Eigen::Vector2d::Zero();
  bool fitted_ = true;
  std::optional<Eigen::Vector3d> cursor_;
  QImage image_, hatch_;
  /// Image and hatching as they are on screen: made anew only when slice, window, place or size change, so that a
  /// gesture over it costs its own drawing alone.
  QImage backdrop_;
  struct Place {
    double zoom_px_mm = 0.0, x = 0.0, y = 0.0, ratio = 0.0;
    bool hidden = false;
    bool operator==(const Place&) const = default;
  } shownPlace_;
  bool stale_ = true;
  Drag drag_ = Drag::None;
  QPointF pressed_, last_;
  bool moved_ = false, space_ = false, hidden_ = false, leftWindows_ = false, rightWindows_ = false, byKeys_ = false;
  int wheel_ = 0;  ///< of fine wheels and touchpads: what no whole step has been made of yet, in eighths of a degree
  /// Of each outline as it was when it was last judged.
  struct Judged {
    Eigen::Matrix3Xd points_lps_mm;
    bool crosses = false;
  };
  std::vector<Judged> judged_;
  const tools::MeasureTool* measurements_ = nullptr;
  const roi::ContourStack* second_ = nullptr;
  std::shared_ptr<const image::Mask> inner_;
  std::vector<Mark> marks_;
  QString hint_, note_;
};

}  // namespace glisson::views
