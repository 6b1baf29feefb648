// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "render/overlay.h"

namespace glisson::session {

/// How a retraction is filmed.
struct VideoWish {
  render::Shown3D shown = render::Shown3D::Answers;
  render::Palette palette = render::Palette::RedBlue;
  render::View3D view = render::View3D::Oblique;
  bool arrows = false;
  int width = 1280, height = 960;
  int perSecond = 25;
  int moving = 60, resting = 10, holding = 25;  ///< pictures on the way, before it and after it
};

/// The 3-D picture from rest to where the run ends, straight and evenly, as .webm or .mp4. Needs a thread without a
/// window's OpenGL context. Throws BadInput, BadArgument (a run that may not be drawn), RenderUnavailable, Cancelled;
/// then nothing of it stays.
void writeRetractionVideo(const std::filesystem::path& file, const render::RetractionScene& scene,
                          const VideoWish& wish, const Progress& progress = {});

}  // namespace glisson::session
