#pragma once

#include "render/overlay.h"

namespace glisson::render {

/// populate3D for a picture drawn pixelScale times larger and scaled down afterwards: text and lines grow with it.
void populateScaled(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options,
                    double pixelScale);

}  // namespace glisson::render
