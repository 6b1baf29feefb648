// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/retraction_video.h"

#include "base/error.h"
#include "render/video.h"

namespace glisson::session {

void writeRetractionVideo(const std::filesystem::path& file, const render::RetractionScene& scene,
                          const VideoWish& wish, const Progress& progress) {
  if (!scene.valid) throw BadInput("this run is no answer and is not drawn: there is nothing to film");
  if (wish.moving < 1) throw BadArgument("a film has at least one picture on the way");
  render::VideoFile video(file, wish.width, wish.height, wish.perSecond);
  render::SceneOptions3D options;
  options.shown = wish.shown;
  options.palette = wish.palette;
  options.view = wish.view;
  options.arrows = wish.arrows;
  options.width = wish.width;
  options.height = wish.height;
  for (int n = 0; n <= wish.moving; ++n) {
    progress.report(static_cast<double>(n) / (wish.moving + 1), "drawing in 3-D");
    options.t = static_cast<double>(n) / wish.moving;
    const render::Picture picture = render::overlay3D(scene, options);
    const int times = 1 + (n == 0 ? wish.resting : n == wish.moving ? wish.holding : 0);
    for (int again = 0; again < times; ++again) video.add(picture);
  }
  video.finish();
}

}  // namespace glisson::session
