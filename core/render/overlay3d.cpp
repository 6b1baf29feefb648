// SPDX-License-Identifier: GPL-3.0-or-later

// The program's side of 3-D pictures: loads the part that draws them when the first one is asked for.
#include <dlfcn.h>

#include <atomic>
#include <exception>

#include "base/error.h"
#include "base/parallel.h"
#include "base/version.h"
#include "render/detail/draw3d.h"
#include "render/overlays3d.h"

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

void overlays3D(const RetractionScene& scene, const std::vector<SceneOptions3D>& options,
                const std::function<void(std::size_t, const Picture&)>& take) {
  for (const SceneOptions3D& o : options)
    if (o.width < 64 || o.height < 64 || o.width > 8000 || o.height > 8000)
      throw BadArgument("a 3-D picture of " + std::to_string(o.width) + " x " + std::to_string(o.height) +
                        " pixels is outside 64..8000");
  const std::scoped_lock lock(textDrawing());
  std::exception_ptr notTaken;
  Draw3dJob job{&scene, &options, renderBackend(), threadCount(), {}, {}};
  job.take = [&](std::size_t n, Picture&& picture) {
    try {
      take(n, picture);
    } catch (...) {
      notTaken = std::current_exception();
    }
    return notTaken == nullptr;
  };
  const std::string build = version() + " " + buildCommit();
  const Draw3dOutcome outcome = draw3d()(build.c_str(), job);
  if (notTaken) std::rethrow_exception(notTaken);
  switch (outcome) {
    case Draw3dOutcome::Drawn: return;
    case Draw3dOutcome::Unavailable: throw RenderUnavailable(job.error);
    case Draw3dOutcome::BadInputFound: throw BadInput(job.error);
    case Draw3dOutcome::BadArgumentFound: throw BadArgument(job.error);
    case Draw3dOutcome::OtherBuild:
      throw RenderUnavailable(std::string(draw3dFile) + " belongs to another version of Glisson; install it again");
    case Draw3dOutcome::Failed: break;
  }
  throw Error(job.error);
}

Picture overlay3D(const RetractionScene& scene, const SceneOptions3D& options) {
  Picture drawn;
  overlays3D(scene, {options}, [&](std::size_t, const Picture& picture) { drawn = picture; });
  return drawn;
}

}  // namespace glisson::render
