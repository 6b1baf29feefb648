// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "roi/contour_stack.h"
#include "roi/edge_paths.h"
#include "roi/set_operations.h"
#include "tools/brush_stroke.h"
#include "tools/sentences.h"
#include "tools/slice_plane.h"

namespace glisson::tools {

/// Distances of the polygon tool, logical pixels.
namespace reach {
inline constexpr double close_px = 10.0;       ///< click on the first vertex closes
inline constexpr double closeTouch_px = 36.0;  ///< the same for a finger
inline constexpr double hit_px = 6.0;          ///< vertex or edge under the mouse; a vertex wins
inline constexpr double drag_px = 3.0;         ///< less is a click
inline constexpr double freehand_px = 8.0;     ///< spacing of freehand points, where nobody chose another (1–100)
inline constexpr double brush_px = 26.0;       ///< radius of the disc, where nobody chose another (4–200)
inline constexpr double simplify = 0.25;       ///< of a pixel spacing: freehand tolerance
inline constexpr double round = 0.02;          ///< of the radius of the disc, where that is less: strokes
inline constexpr double smooth = 0.1;          ///< of a pixel spacing: polygons of ellipses and splines
inline constexpr int minimumVoxels = 4;        ///< a smaller region is refused
}  // namespace reach

/// Where the tool stands. Editing: a closed outline that is not accepted yet is selected. Accepted: an accepted one is.
enum class ToolState { Idle, Drawing, Editing, Accepted };

struct Modifiers {
  bool shift = false, ctrl = false;
};

/// What the left button does. Freehand: a drag always draws, and letting go closes. Sculpt: a disc pushes the outline.
/// Ellipse: a drag draws one, with Shift a circle. Brush, Eraser: a disc adds to the outlines under it, or takes away,
/// as far as the image looks like where it was pressed; with Shift all that lies under it. Livewire: clicks are joined
/// along the edges of the image. Spline: a smooth closed curve runs through the clicked points.
enum class ToolMode { Polygon, Freehand, Sculpt, Ellipse, Brush, Eraser, Livewire, Spline };
inline constexpr std::size_t toolModeCount = static_cast<std::size_t>(ToolMode::Spline) + 1;

/// A mouse position of the view.
struct Pointer {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< logical pixels
  Modifiers modifiers;
  bool touch = false;  ///< a finger: reaches are larger
};

enum class ToolKey { Enter, CtrlEnter, Backspace, Delete, Escape };

/// What a gesture asks to change. The tool never changes contours itself: whoever owns them makes one undoable step of
/// each.
struct AddPolygon {
  roi::Polygon polygon;
};
struct RemovePolygon {
  std::size_t index;
};
enum class PointsChange { Move, Insert, Delete, Sculpt, Nudge };
struct ChangePoints {
  std::size_t index;
  Eigen::Matrix3Xd points_lps_mm;
  PointsChange change;
  bool toDraft = false;  ///< the outline counted, and has to be accepted anew
};
struct ChangeState {
  std::size_t index;
  roi::PolygonState state;
};
struct ChangeKind {
  std::size_t index;
  bool exclude;
};
enum class ReplaceReason { Cut, Brush, Erase, Unite, Subtract, Intersect };
/// Polygons give way to others: those that come first take their places, what is more comes last; places without a
/// successor go.
struct ReplacePolygons {
  std::vector<std::size_t> indices;  ///< ascending; none: all parts are new
  std::vector<roi::Polygon> parts;
  ReplaceReason reason;
};
using Act = std::variant<AddPolygon, RemovePolygon, ChangePoints, ChangeState, ChangeKind, ReplacePolygons>;
using Acts = std::vector<Act>;

/// What is under the mouse: a vertex, an edge (from vertex to vertex + 1), or the inside of a polygon.
struct Hit {
  enum class Kind { Vertex, Edge, Inside } kind = Kind::Vertex;
  std::size_t polygon = 0;
  Eigen::Index vertex = 0;  ///< Vertex and Edge
  bool operator==(const Hit&) const = default;
};

/// Draws and edits closed polygons on slices. A state machine with no window in it: positions in, acts out.
class PolygonTool {
 public:
  /// contours: watched, never changed; must outlive the tool.
  explicit PolygonTool(const roi::ContourStack& contours) : contours_(contours) {}

  // Gestures. Each returns the acts it asks for, to be applied at once, in order, before the next gesture.
  Acts press(const Pointer& at, const SlicePlane& plane);    ///< left button
  Acts move(const Pointer& at, const SlicePlane& plane);     ///< with or without the left button
  Acts release(const Pointer& at, const SlicePlane& plane);  ///< left button
  Acts doubleClick(const Pointer& at, const SlicePlane& plane);
  /// Drawing: closes. Else what is under the mouse is selected, for the menu that follows.
  Acts rightClick(const Pointer& at, const SlicePlane& plane);
  Acts key(ToolKey key, const SlicePlane& plane);
  /// Before another slice, series or tool is shown: parks an unfinished outline as a draft.
  Acts leaveSlice(const SlicePlane& plane);
  /// Another tool: parks an unfinished outline as a draft.
  Acts setMode(ToolMode mode, const SlicePlane& plane);
  ToolMode mode() const { return mode_; }
  void setFreehandSpacing(double px);
  double freehandSpacing() const { return freehand_px_; }
  void setBrushRadius(double px);
  double brushRadius() const { return brush_px_; }
  bool hasDisc() const { return mode_ == ToolMode::Sculpt || paints(); }
  /// The image that is drawn on: what brush, eraser and livewire follow. Null: they follow nothing.
  void setImage(std::shared_ptr<const image::ScalarVolume> image);

  // Acts on the selection; nothing where nothing is selected, with the reason as the message.
  Acts nudge(const Eigen::Vector2d& pixels, const SlicePlane& plane);  ///< image pixels to the right and down the view
  Acts split(
      const SlicePlane& plane);  ///< two vertices apart: cuts the outline in two there; else halves the selected edges
  Acts trim(const SlicePlane&
                plane);  ///< two vertices apart: cuts the smaller part off; else every second selected vertex goes
  Acts setKind(bool exclude);
  /// The selected outline, as a set of points, with those of its kind on the slice that it meets: they become one
  /// region (Union), it is taken out of them (Difference), or what both hold stays (Intersection).
  Acts combine(roi::SetOperation operation, const SlicePlane& plane);
  void selectAll(const SlicePlane& plane);  ///< the selected outline as a whole, else the nearest of the slice
  void deselect() { select(std::nullopt); }
  /// Whole gestures that ended in a wish for the properties of an outline; asked once.
  std::optional<std::size_t> takePropertiesWish() { return std::exchange(properties_, std::nullopt); }
  /// Undo and redo while drawing: whole gestures of the outline in work. False where there is nothing of it to undo.
  bool undoDrawing(const SlicePlane& plane);
  bool redoDrawing(const SlicePlane& plane);
  bool canRedoDrawing() const { return !future_.empty(); }
  /// After contours were changed by undo, redo or import: forgets what no longer exists.
  void contoursChanged();
  /// After a step that moved polygons to other places of the list: which one is selected now, as a whole.
  void selectPolygon(std::optional<std::size_t> polygon) { select(polygon); }

  // What a view shows.
  ToolState state() const;
  const Eigen::Matrix3Xd& drawing() const { return points_; }  ///< clicked points, 3 × n LPS mm, open
  /// The outline that closing would make of them now; the same points but for Livewire and Spline.
  const Eigen::Matrix3Xd& outlineInWork() const { return outline_.cols() > 0 ? outline_ : points_; }
  /// Livewire and Spline: the line through the clicked points and the mouse; empty in other modes.
  const Eigen::Matrix3Xd& curve() const { return curve_; }
  /// What a drag has drawn so far, closed rings, LPS mm: an ellipse, or what brush or eraser went over.
  const std::vector<Eigen::Matrix3Xd>& shape() const { return shape_; }
  const std::optional<Eigen::Vector3d>& pointer() const { return pointer_; }  ///< end of the rubber band, LPS mm
  bool closes() const { return closes_; }                                     ///< the mouse is on the first vertex
  bool crosses() const { return crosses_; }                                   ///< the outline in work crosses itself
  std::optional<Hit> hover() const { return hover_; }
  std::optional<std::size_t> selected() const { return selected_; }
  bool interpolated() const;  ///< an interpolated outline is selected
  const std::vector<Eigen::Index>& selectedVertices() const { return vertices_; }
  /// Points of the selected polygon while it is being dragged; empty otherwise.
  const Eigen::Matrix3Xd& preview() const { return preview_; }
  struct Box {
    Eigen::Vector2d from_px, to_px;
  };
  std::optional<Box> box() const { return box_; }
  /// Centre of the disc, LPS mm, while the mouse is over the view in a mode that has one.
  std::optional<Eigen::Vector3d> brush() const { return hasDisc() ? pointer_ : std::nullopt; }
  bool dragging() const { return drag_ != Drag::None && drag_ != Drag::Press; }
  /// One sentence for the status line: a refusal, a question, a hint. Empty where there is nothing to say.
  const Sentence& message() const { return message_; }
  Sentence takeMessage() { return std::exchange(message_, {}); }  ///< to be said once

 private:
  enum class Drag { None, Press, Freehand, Move, Box, Sculpt, Ellipse, Brush };

  std::optional<Hit> hitTest(const Eigen::Vector2d& px, const SlicePlane& plane) const;
  bool onFirstVertex(const Pointer& at, const SlicePlane& plane) const;
  void beginDrag(const SlicePlane& plane);
  void beginSculpt(const SlicePlane& plane);
  void sculptTo(const Eigen::Vector2d& px, const SlicePlane& plane);
  std::optional<std::size_t> nearestPolygon(const Eigen::Vector2d& px, const SlicePlane& plane) const;
  Acts endDrag(Drag was, const Pointer& at, const SlicePlane& plane);
  Acts clickHandle(const Pointer& at, const SlicePlane& plane);
  Eigen::Vector3d snapped(const Pointer& at, const SlicePlane& plane) const;
  void addVertex(const Eigen::Vector3d& p_lps);
  void endFreehand(const SlicePlane& plane);
  Acts click(const Pointer& at, const SlicePlane& plane);
  Acts close(const SlicePlane& plane, bool accept);
  Acts closeOutline(Eigen::Matrix3Xd points, const SlicePlane& plane, bool accept);
  Acts accept(const SlicePlane& plane);
  Acts removeSelection(const SlicePlane& plane);
  Acts changed(std::size_t index, Eigen::Matrix3Xd points, PointsChange change, const SlicePlane& plane);
  Acts cutAlong(std::size_t index, Eigen::Matrix3Xd first, Eigen::Matrix3Xd second, const SlicePlane& plane);
  bool crosses(const Eigen::Matrix3Xd& points, const SlicePlane& plane) const;
  Sentence refusal(const Eigen::Matrix3Xd& points, const SlicePlane& plane, bool edit = false) const;
  static roi::Polygon polygonOf(Eigen::Matrix3Xd points, const SlicePlane& plane, roi::PolygonState state);
  Eigen::Matrix2Xd planePoints(const Eigen::Matrix3Xd& points, const SlicePlane& plane) const;
  void updateCrossing(const SlicePlane& plane);
  void select(std::optional<std::size_t> polygon, std::vector<Eigen::Index> vertices = {});
  void clearDrawing();
  // polygon_tool_curves.cpp
  bool curved() const { return mode_ == ToolMode::Livewire || mode_ == ToolMode::Spline; }
  void updateCurve(const SlicePlane& plane);
  Eigen::Matrix3Xd closedOutline(const SlicePlane& plane);
  const Eigen::Matrix3Xd& legBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const SlicePlane& plane);
  Eigen::Matrix3Xd pathBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const SlicePlane& plane);
  Eigen::Matrix3Xd spline(const Eigen::Matrix3Xd& through, const SlicePlane& plane) const;
  void drawEllipse(const Pointer& at, const SlicePlane& plane);
  // polygon_tool_regions.cpp
  bool paints() const { return mode_ == ToolMode::Brush || mode_ == ToolMode::Eraser; }
  bool followsImage(const SlicePlane& plane) const;
  void paintTo(const Pointer& at, const SlicePlane& plane);
  Acts endBrush(const SlicePlane& plane);
  roi::FlatRegion regionOf(const std::vector<std::size_t>& polygons, const SlicePlane& plane) const;
  std::vector<std::size_t> meeting(std::vector<Outline> rings, bool exclude, std::optional<std::size_t> without,
                                   const SlicePlane& plane) const;
  struct Parts {
    std::vector<roi::Polygon> parts;    ///< new ones, largest first
    std::vector<std::size_t> replaced;  ///< those of the group that are not among the result as they were
    std::size_t small = 0;              ///< parts and holes left out for holding too few voxels
  };
  /// group: what the region was made of. like: state and kind of new parts.
  Parts partsOf(const roi::FlatRegion& region, const std::vector<std::size_t>& group, const roi::Polygon& like,
                const SlicePlane& plane) const;
  roi::PolygonState stateOf(const std::vector<std::size_t>& polygons) const;
  Acts replaced(Parts parts, ReplaceReason reason, const char* said);

  const roi::ContourStack& contours_;
  Eigen::Matrix3Xd points_;             ///< of the outline in work
  std::vector<Eigen::Matrix3Xd> past_;  ///< the outline before each gesture, for undo while drawing
  std::vector<Eigen::Matrix3Xd> future_;
  std::optional<Eigen::Vector3d> pointer_;
  bool closes_ = false, crosses_ = false, asked_ = false;
  std::optional<Hit> hover_;
  std::optional<std::size_t> selected_;
  std::vector<Eigen::Index> vertices_;
  Eigen::Matrix3Xd preview_;
  std::optional<Box> box_;
  Sentence message_;
  Drag drag_ = Drag::None;
  Eigen::Vector2d pressed_px_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d lastFreehand_px_ = Eigen::Vector2d::Zero();
  Modifiers pressedModifiers_;
  std::optional<Hit> pressedHit_;
  Eigen::Index freehandStart_ = 0;
  ToolMode mode_ = ToolMode::Polygon;
  double freehand_px_ = reach::freehand_px, brush_px_ = reach::brush_px;
  std::optional<std::size_t> properties_;
  std::shared_ptr<const image::ScalarVolume> image_;
  std::vector<Eigen::Matrix3Xd> shape_;
  std::optional<BrushStroke> stroke_;
  Eigen::Matrix3Xd curve_, outline_;
  struct Leg {
    Eigen::Vector3d from, to;
    Eigen::Matrix3Xd path;  ///< with both ends
  };
  std::vector<Leg> legs_;  ///< between clicked points, found once each
  std::optional<roi::EdgePaths> paths_;
  int pathsSlice_ = -1;
  std::optional<Eigen::Vector3d> pathsFrom_;  ///< where paths_ starts
};

}  // namespace glisson::tools
