// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "render/overlay.h"

namespace glisson::render {

/// The scene drawn off screen as often as there are options, in one window: its context, and the shaders compiled in
/// it, are most of what a 3-D picture costs. take(n, picture) is called in their order; each picture is the one that
/// overlay3D gives. What take throws ends the drawing and is thrown here. Throws as overlay3D does.
void overlays3D(const RetractionScene& scene, const std::vector<SceneOptions3D>& options,
                const std::function<void(std::size_t, const Picture&)>& take);

}  // namespace glisson::render
