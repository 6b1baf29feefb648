// SPDX-License-Identifier: GPL-3.0-or-later

// The program's side of 3-D pictures: loads the part that draws them when the first one is asked for.
#include <dlfcn.h>

#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "render/detail/draw3d.h"
#include "render/overlay.h"

namespace glisson::render {
namespace {

std::atomic<RenderBackend> chosenBackend{RenderBackend::Auto};

/// Loads it once; the file is looked for where the program was told at link time that its libraries are (RPATH).
Draw3d* draw3d() {
  static Draw3d* const entry = [] {
    void* library = dlopen(draw3dFile, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
      const char* why = dlerror();
      throw RenderUnavailable("the part of the program that draws in 3-D cannot be loaded (" +
                              std::string(why ? why : draw3dFile) +
                              "); install Glisson and its libraries again, or ask for no 3-D picture");
    }
    auto* found = reinterpret_cast<Draw3d*>(dlsym(library, draw3dEntry));
    if (!found) throw RenderUnavailable(std::string(draw3dFile) + " is not the part of Glisson that draws in 3-D");
    return found;
  }();
  return entry;
}

}  // namespace

void setRenderBackend(RenderBackend backend) {
  chosenBackend = backend;
}
RenderBackend renderBackend() {
  return chosenBackend;
}

std::mutex& textDrawing() {
  static std::mutex oneAtATime;
  return oneAtATime;
}

Picture overlay3D(const RetractionScene& scene, const SceneOptions3D& options) {
  if (options.width < 64 || options.height < 64 || options.width > 8000 || options.height > 8000)
    throw BadArgument("a 3-D picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                      " pixels is outside 64..8000");
  const std::scoped_lock lock(textDrawing());
  Draw3dJob job{&scene, &options, renderBackend(), threadCount(), {}, {}};
  const std::string build = version() + " " + buildCommit();
  switch (draw3d()(build.c_str(), job)) {
    case Draw3dOutcome::Drawn: return std::move(job.picture);
    case Draw3dOutcome::Unavailable: throw RenderUnavailable(job.error);
    case Draw3dOutcome::BadInputFound: throw BadInput(job.error);
    case Draw3dOutcome::BadArgumentFound: throw BadArgument(job.error);
    case Draw3dOutcome::OtherBuild:
      throw RenderUnavailable(std::string(draw3dFile) + " belongs to another version of Glisson; install it again");
    case Draw3dOutcome::Failed: break;
  }
  throw Error(job.error);
}

}  // namespace glisson::render
