// SPDX-License-Identifier: GPL-3.0-or-later

// The part of the program that draws in 3-D off screen; everything that needs VTK's rendering or OpenGL is in here.
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "render/detail/draw3d.h"
#include "render/detail/scene_fields.h"
#include "render/offscreen_window.h"
#include "render/overlay.h"

namespace glisson::render {
namespace {

constexpr int samples = 4;  ///< of a pixel; twice the picture both ways would look the same, and take 300 MB more

/// One window for all pictures: its context, and the shaders compiled in it, are most of what a picture costs.
void draw(const Draw3dJob& job) {
  if (job.options->empty()) return;
  const SceneOptions3D& first = job.options->front();
  OffscreenWindow window(first.width, first.height, job.backend);
  SceneFields fields(*job.scene);
  for (std::size_t n = 0; n < job.options->size(); ++n) {
    const SceneOptions3D& options = (*job.options)[n];
    window.setSize(options.width, options.height, samples);
    vtkNew<vtkRenderer> renderer;
    window.window()->AddRenderer(renderer);
    populate3D(renderer, *job.scene, options, fields);
    Picture picture = window.capture();
    window.window()->RemoveRenderer(renderer);
    if (!job.take(n, std::move(picture))) return;
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) Draw3dOutcome glissonDraw3d(const char* build,
                                                                              Draw3dJob& job) noexcept {
  // Nothing of the job is touched before it is known to be laid out alike here and there.
  if (build != version() + " " + buildCommit()) return Draw3dOutcome::OtherBuild;
  try {
    setThreadCount(job.threads);
    draw(job);
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
