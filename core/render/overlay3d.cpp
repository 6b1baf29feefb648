#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "base/error.h"
#include "render/offscreen_window.h"
#include "render/overlay.h"
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

}  // namespace

std::mutex& textDrawing() {
  static std::mutex oneAtATime;
  return oneAtATime;
}

Picture overlay3D(const RetractionScene& scene, const SceneOptions3D& options) {
  if (options.width < 64 || options.height < 64 || options.width > 8000 || options.height > 8000)
    throw BadArgument("a 3-D picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                      " pixels is outside 64..8000");
  const std::scoped_lock lock(textDrawing());
  OffscreenWindow window(2 * options.width, 2 * options.height, renderBackend());
  vtkNew<vtkRenderer> renderer;
  window.window()->AddRenderer(renderer);
  populateScaled(renderer, scene, options, 2.0);
  return halved(window.capture());
}

}  // namespace glisson::render
