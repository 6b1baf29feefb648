// The part of the program that draws in 3-D off screen; everything that needs VTK's rendering or OpenGL is in here.
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "render/detail/draw3d.h"
#include "render/offscreen_window.h"
#include "render/scene3d.h"

namespace glisson::render {
namespace {

/// Mean of 2 × 2 pixels.
Picture halved(const Picture& large) {
  Picture small{large.width / 2, large.height / 2, {}};
  small.rgb.resize(3 * static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
  const auto row = 3 * static_cast<std::size_t>(large.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(small.height); ++y)
    for (std::size_t x = 0; x < static_cast<std::size_t>(small.width); ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint8_t* p = large.rgb.data() + 2 * y * row + 6 * x + c;
        small.rgb[3 * (y * static_cast<std::size_t>(small.width) + x) + c] =
            static_cast<std::uint8_t>((p[0] + p[3] + p[row] + p[row + 3] + 2) / 4);
      }
  return small;
}

Picture drawn(const Draw3dJob& job) {
  OffscreenWindow window(2 * job.options->width, 2 * job.options->height, job.backend);
  vtkNew<vtkRenderer> renderer;
  window.window()->AddRenderer(renderer);
  populateScaled(renderer, *job.scene, *job.options, 2.0);
  return halved(window.capture());
}

}  // namespace

extern "C" __attribute__((visibility("default"))) Draw3dOutcome glissonDraw3d(const char* build,
                                                                              Draw3dJob& job) noexcept {
  // Nothing of the job is touched before it is known to be laid out alike here and there.
  if (build != version() + " " + buildCommit()) return Draw3dOutcome::OtherBuild;
  try {
    setThreadCount(job.threads);
    job.picture = drawn(job);
    return Draw3dOutcome::Drawn;
  } catch (const RenderUnavailable& e) {
    job.error = e.what();
    return Draw3dOutcome::Unavailable;
  } catch (const BadInput& e) {
    job.error = e.what();
    return Draw3dOutcome::BadInputFound;
  } catch (const BadArgument& e) {
    job.error = e.what();
    return Draw3dOutcome::BadArgumentFound;
  } catch (const std::exception& e) {
    job.error = e.what();
    return Draw3dOutcome::Failed;
  }
}

}  // namespace glisson::render
