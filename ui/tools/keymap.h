// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace glisson::tools {

/// Everything a key can do in the views. The sheet under F1, tooltips and the key settings come from keyTable().
enum class Command {
  Polygon,
  Freehand,
  Sculpt,
  Ellipse,
  Brush,
  Eraser,
  Livewire,
  Spline,
  Measure,
  WindowLevel,
  CloseOrAccept,
  CloseAndAccept,
  LastVertex,
  Delete,
  Split,
  Trim,
  Unite,
  Subtract,
  Intersect,
  Park,
  Undo,
  Redo,
  SelectAll,
  Deselect,
  Copy,
  Paste,
  PasteBetween,
  NudgeLeft,
  NudgeRight,
  NudgeUp,
  NudgeDown,
  NudgeLeftFar,
  NudgeRightFar,
  NudgeUpFar,
  NudgeDownFar,
  CrosshairLeft,
  CrosshairRight,
  CrosshairUp,
  CrosshairDown,
  CrosshairLeftFar,
  CrosshairRightFar,
  CrosshairUpFar,
  CrosshairDownFar,
  ClickHere,
  FirstSlice,
  LastSlice,
  SliceUp,
  SliceDown,
  NextPending,
  MarkNoLiver,
  MarkNoWave,
  Include,
  Exclude,
  InnerRoi,
  InnerLess,
  InnerMore,
  HideOverlays,
  AutoWindow,
  Preset1,
  Preset2,
  Preset3,
  Preset4,
  Preset5,
  LinkViews,
  StiffnessScale,
  Interpolate,
  AcceptAll,
  Propose,
  CompareReaders,
  PlayWave,
  Planes,
  FillWindow,
  Fuse,
  Help
};
inline constexpr std::size_t commandCount = static_cast<std::size_t>(Command::Help) + 1;

struct KeyEntry {
  Command command;
  const char* id;     ///< stable name, for settings
  const char* keys;   ///< as shipped; alternatives parted by spaces: "PgUp", "Ctrl+Shift+V"
  const char* group;  ///< heading of the sheet
  const char* what;   ///< a few words
};

/// One row per command, in the order of Command.
std::span<const KeyEntry> keyTable();
const KeyEntry& entryOf(Command command);
/// The command of a stable name.
std::optional<Command> commandNamed(std::string_view id);

/// What the mouse does, by the state of the tool; empty = nothing.
struct GestureEntry {
  const char *gesture, *idle, *drawing, *editing;
};
std::span<const GestureEntry> gestureTable();

/// What mouse and keys do over a 3-D view, and over a finished picture.
struct SceneEntry {
  const char *what, *mouse, *keys;
};
std::span<const SceneEntry> sceneTable();

}  // namespace glisson::tools
