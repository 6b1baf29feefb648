// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/keymap.h"

#include <algorithm>
#include <array>

namespace glisson::tools {

namespace {

using C = Command;
constexpr const char* toolsGroup = "Tools";
constexpr const char* outline = "Outline";
constexpr const char* slices = "Slices";
constexpr const char* view = "View";

constexpr std::array<KeyEntry, commandCount> keyRows = {{
    {C::Polygon, "polygon", "P", toolsGroup, "Polygon"},
    {C::Freehand, "freehand", "F", toolsGroup, "Freehand: letting go closes"},
    {C::Sculpt, "sculpt", "R", toolsGroup, "Sculpt: push the outline with a disc"},
    {C::Ellipse, "ellipse", "Q", toolsGroup, "Ellipse: drag from corner to corner; with Shift a circle"},
    {C::Brush, "brush", "D", toolsGroup, "Brush that keeps to the edges of the image; with Shift the whole disc"},
    {C::Eraser, "eraser", "Shift+D", toolsGroup,
     "Eraser that keeps to the edges of the image; with Shift the whole disc"},
    {C::Livewire, "livewire", "J", toolsGroup, "Livewire: clicks joined along the edges of the image"},
    {C::Spline, "spline", "Y", toolsGroup, "Spline: a smooth outline through the clicks"},
    {C::Measure, "measure", "M", toolsGroup, "Measure a distance"},
    {C::WindowLevel, "window-level", "W", toolsGroup, "Window and level by dragging"},
    {C::CloseOrAccept, "accept", "Return Enter", outline, "Close or accept"},
    {C::CloseAndAccept, "close-and-accept", "Ctrl+Return Ctrl+Enter", outline, "Close and accept"},
    {C::LastVertex, "last-vertex", "Backspace", outline, "Take the last vertex back; take a draft up again"},
    {C::Delete, "delete", "Del", outline, "Delete the selected vertices or outline"},
    {C::Split, "split", "+ =", outline, "Split: halve the selected edges; two vertices apart: cut in two"},
    {C::Trim, "trim", "- _", outline, "Trim: thin out the selection; two vertices apart: cut the smaller part off"},
    {C::Unite, "unite", "U", outline, "Unite: join the selected outline with those it meets"},
    {C::Subtract, "subtract", "Shift+U", outline, "Take out: cut the selected outline out of those it meets"},
    {C::Intersect, "intersect", "Ctrl+U", outline,
     "In common: keep what the selected outline shares with those it meets"},
    {C::Park, "park", "Esc", outline, "Park as draft; again: discard"},
    {C::Undo, "undo", "Ctrl+Z", outline, "Undo"},
    {C::Redo, "redo", "Ctrl+Shift+Z Ctrl+Y", outline, "Redo"},
    {C::SelectAll, "select-all", "Ctrl+A", outline, "Select the whole outline"},
    {C::Deselect, "deselect", "Ctrl+D", outline, "Select nothing"},
    {C::Copy, "copy", "Ctrl+C", outline, "Copy the outline, or all of the slice"},
    {C::Paste, "paste", "Ctrl+V", outline, "Paste on this slice"},
    {C::PasteBetween, "paste-between", "Ctrl+Shift+V", outline, "Paste on all empty slices between"},
    {C::NudgeLeft, "nudge-left", "Left", outline, "Nudge left by 0.1 pixel"},
    {C::NudgeRight, "nudge-right", "Right", outline, "Nudge right by 0.1 pixel"},
    {C::NudgeUp, "nudge-up", "Up", outline, "Nudge up by 0.1 pixel; nothing selected: next slice"},
    {C::NudgeDown, "nudge-down", "Down", outline, "Nudge down by 0.1 pixel; nothing selected: slice before"},
    {C::NudgeLeftFar, "nudge-left-far", "Shift+Left", outline, "Nudge left by 1 pixel"},
    {C::NudgeRightFar, "nudge-right-far", "Shift+Right", outline, "Nudge right by 1 pixel"},
    {C::NudgeUpFar, "nudge-up-far", "Shift+Up", outline, "Nudge up by 1 pixel"},
    {C::NudgeDownFar, "nudge-down-far", "Shift+Down", outline, "Nudge down by 1 pixel"},
    {C::CrosshairLeft, "crosshair-left", "Ctrl+Left", outline, "Crosshair left by 1 pixel"},
    {C::CrosshairRight, "crosshair-right", "Ctrl+Right", outline, "Crosshair right by 1 pixel"},
    {C::CrosshairUp, "crosshair-up", "Ctrl+Up", outline, "Crosshair up by 1 pixel"},
    {C::CrosshairDown, "crosshair-down", "Ctrl+Down", outline, "Crosshair down by 1 pixel"},
    {C::CrosshairLeftFar, "crosshair-left-far", "Ctrl+Shift+Left", outline, "Crosshair left by 10 pixels"},
    {C::CrosshairRightFar, "crosshair-right-far", "Ctrl+Shift+Right", outline, "Crosshair right by 10 pixels"},
    {C::CrosshairUpFar, "crosshair-up-far", "Ctrl+Shift+Up", outline, "Crosshair up by 10 pixels"},
    {C::CrosshairDownFar, "crosshair-down-far", "Ctrl+Shift+Down", outline, "Crosshair down by 10 pixels"},
    {C::ClickHere, "click-here", "C Ins", outline, "Click at the crosshair: vertex, close on the first one, select"},
    {C::FirstSlice, "first-slice", "Home", slices, "First slice"},
    {C::LastSlice, "last-slice", "End", slices, "Last slice"},
    {C::SliceUp, "slice-up", "PgUp", slices, "Next slice"},
    {C::SliceDown, "slice-down", "PgDown", slices, "Slice before"},
    {C::NextPending, "next-pending", "N", slices, "Next slice that is still to be done"},
    {C::MarkNoLiver, "mark-no-liver", "A", slices, "Mark: no liver on this slice"},
    {C::MarkNoWave, "mark-no-wave", "S", slices, "Mark: no reliable wave on this slice"},
    {C::Include, "include", "I", outline, "This outline counts"},
    {C::Exclude, "exclude", "X", outline, "This outline is left out (vessel, cyst)"},
    {C::InnerRoi, "inner-roi", "E", outline, "Inner region: measure away from the edge"},
    {C::InnerLess, "inner-less", "[", outline, "Less erosion; with a disc in hand: smaller disc"},
    {C::InnerMore, "inner-more", "]", outline, "More erosion; with a disc in hand: larger disc"},
    {C::HideOverlays, "hide-overlays", "H", view, "Hold to hide all overlays"},
    {C::AutoWindow, "auto-window", "0", view, "Window from the image"},
    {C::Preset1, "preset-1", "1", view, "Window: soft (widest)"},
    {C::Preset2, "preset-2", "2", view, "Window: liver"},
    {C::Preset3, "preset-3", "3", view, "Window: vessels"},
    {C::Preset4, "preset-4", "4", view, "Window: bright"},
    {C::Preset5, "preset-5", "5", view, "Window: dark"},
    {C::LinkViews, "link-views", "L", view, "Link slice, zoom and place of the views"},
    {C::StiffnessScale, "stiffness-scale", "K", view, "Stiffness scale 0–8 or 0–20 kPa"},
    {C::Interpolate, "interpolate", "B", slices, "Interpolate between outlined slices"},
    {C::AcceptAll, "accept-all", "Shift+B", slices, "Accept all interpolated outlines"},
    {C::Propose, "propose", "G", outline, "Propose an outline: grow a region from under the mouse"},
    {C::CompareReaders, "compare-readers", "Ctrl+Shift+D", outline, "Compare with a second reader's outlines"},
    {C::PlayWave, "play-wave", "V", view, "Play or stop the wave"},
    {C::Planes, "planes", "T", view, "Three planes, linked by the crosshair"},
    {C::FillWindow, "fill-window", "Z", view, "The view under the mouse alone, and back"},
    {C::Fuse, "fuse", "O", view, "Stiffness over the MRI, on and off"},
    {C::Help, "help", "F1", view, "This sheet"},
}};

constexpr std::array<GestureEntry, 10> gestureRows = {{
    {"Left click", "first vertex", "add vertex; on the first one: close",
     "select vertex, edge or outline; on empty: clear"},
    {"Left drag", "freehand", "freehand, mixes with clicks", "move the selection; on empty: box select"},
    {"Double-click", "on an outline: properties and statistics", "add last vertex and close",
     "accept; accepted: properties and statistics"},
    {"Right click", "menu", "close", "menu: delete, split, copy to slices, kind"},
    {"Right drag, Ctrl+wheel", "zoom", "zoom, the drawing is kept", "zoom"},
    {"Middle drag, Space+drag", "pan", "pan, the drawing is kept", "pan"},
    {"Wheel", "slice", "slice; the drawing is parked as a draft", "slice"},
    {"Alt+drag (or right drag: View, Mouse)", "window and level", "window and level, the drawing is kept",
     "window and level"},
    {"Ctrl+click", "", "", "on an edge: insert a vertex; on a vertex: delete it"},
    {"Shift+click", "inside an outline: start a hole", "steps of 45°", "add to or take from the selection"},
}};

constexpr std::array<SceneEntry, 9> sceneRows = {{
    {"Turn the 3-D view", "left drag", "arrows"},
    {"Move the 3-D view", "middle drag, Shift+left drag", "Shift+arrows"},
    {"Zoom", "wheel, right drag (picture: Ctrl+wheel)", "+ and -"},
    {"Show all", "double-click", "Home"},
    {"Choose a handle or a vessel", "click it", "Space: the next"},
    {"Move the chosen handle, or the live tool", "drag it", "Ctrl+arrows: 1 mm; with Shift: 10 mm"},
    {"Hold the liver, after \"Hold here…\"", "click on the liver", "Enter: in the middle of the view"},
    {"Undo what was laid", "", "Ctrl+Z"},
    {"Slice of a picture", "wheel", "up and down"},
}};

}  // namespace

std::span<const KeyEntry> keyTable() {
  return keyRows;
}

const KeyEntry& entryOf(Command command) {
  return keyRows[static_cast<std::size_t>(command)];
}

std::optional<Command> commandNamed(std::string_view id) {
  const auto found = std::find_if(keyRows.begin(), keyRows.end(), [id](const KeyEntry& e) { return id == e.id; });
  if (found == keyRows.end()) return std::nullopt;
  return found->command;
}

std::span<const GestureEntry> gestureTable() {
  return gestureRows;
}

std::span<const SceneEntry> sceneTable() {
  return sceneRows;
}

}  // namespace glisson::tools
