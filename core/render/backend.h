// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glisson::render {

/// How pictures of 3-D scenes are drawn without a window. Slice pictures and charts need none of them.
/// Auto: EGL without any display, else EGL on the X server that DISPLAY names.
enum class RenderBackend { Auto, Egl, X11 };

/// Sets the backend of off-screen drawing for the whole program; call before the first picture.
void setRenderBackend(RenderBackend backend);
RenderBackend renderBackend();

}  // namespace glisson::render
