// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random.h"
#include "commands/undo_stack.h"
#include "session/act_command.h"
#include "support/same_outlines.h"
#include "tools/polygon_tool.h"

namespace glisson::test {

/// An oblique, anisotropic slice stack under the polygon tool, with undo: what the workstation does, without a window.
struct ToolBench {
  tools::SlicePlane plane;
  commands::Outlines contours;
  commands::UndoStack undo;
  tools::PolygonTool tool{contours};

  ToolBench() {
    plane.grid.size = {80, 60, 5};
    plane.grid.spacing_mm = {1.5, 2.0, 6.0};
    plane.grid.origin_lps_mm = {-40.0, 25.0, 110.0};
    plane.grid.direction =
        (Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    plane.slice = 2;
    plane.offset_px = {10.0, 20.0};
    plane.scale_px_mm = {4.0, 4.0};
  }
  void apply(const tools::Acts& acts) {
    for (const tools::Act& act : acts) undo.push(session::commandOf(act, contours), contours);
    if (!acts.empty()) tool.contoursChanged();
  }
  static tools::Pointer at(double x, double y, tools::Modifiers m = {}) { return {{x, y}, m}; }
  void press(double x, double y, tools::Modifiers m = {}) { apply(tool.press(at(x, y, m), plane)); }
  void move(double x, double y, tools::Modifiers m = {}) { apply(tool.move(at(x, y, m), plane)); }
  void release(double x, double y, tools::Modifiers m = {}) { apply(tool.release(at(x, y, m), plane)); }
  void click(double x, double y, tools::Modifiers m = {}) {
    move(x, y, m);
    press(x, y, m);
    release(x, y, m);
  }
  void drag(double x0, double y0, double x1, double y1, tools::Modifiers m = {}) {
    press(x0, y0, m);
    for (int s = 1; s <= 10; ++s) move(x0 + (x1 - x0) * s / 10.0, y0 + (y1 - y0) * s / 10.0, m);
    release(x1, y1, m);
  }
  void key(tools::ToolKey k) { apply(tool.key(k, plane)); }
  /// A closed square with its upper left corner there, left in Editing.
  void square(double x, double y, double side) {
    click(x, y);
    click(x + side, y);
    click(x + side, y + side);
    click(x, y + side);
    key(tools::ToolKey::Enter);
  }
};

}  // namespace glisson::test
