// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "tools/model_picture.h"
#include "views/scene_view.h"

class vtkRenderer;

namespace glisson::views {

/// A model before a run: surface with its stiffness, vessels, sites, what holds it, and the bar.
class ModelLayer {
 public:
  /// pixelRatio: device pixels per logical one.
  ModelLayer(const tools::ModelPicture& picture, double pixelRatio);
  ~ModelLayer();

  void addTo(vtkRenderer& renderer);
  void show(const ModelParts& parts);

 private:
  struct Private;
  std::unique_ptr<Private> d_;
};

}  // namespace glisson::views
