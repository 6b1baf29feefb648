// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "render/backend.h"
#include "render/picture.h"

class vtkRenderWindow;

namespace glisson::render {

/// An OpenGL window that is never shown: an EGL context without a surface on any screen, so it works with no X server
/// and no DISPLAY. VTK's own default window is never made: it ends the process where there is no display.
/// Made, used and ended on one thread.
class OffscreenWindow {
 public:
  /// Throws RenderUnavailable where no context can be had, naming what was tried.
  OffscreenWindow(int width, int height, RenderBackend backend);
  ~OffscreenWindow();
  OffscreenWindow(const OffscreenWindow&) = delete;
  OffscreenWindow& operator=(const OffscreenWindow&) = delete;

  vtkRenderWindow* window();

  /// For the next picture. samples: per pixel against stairs at edges; 0 = none.
  void setSize(int width, int height, int samples);

  /// Renders and reads the pixels. Throws Error where VTK reports a fault while drawing.
  Picture capture();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace glisson::render
