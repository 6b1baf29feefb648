// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkNew.h>

#include "tools/model_picture.h"

class vtkActor;
class vtkTransform;

namespace glisson::views {

/// The retractor's bar in a 3-D scene.
class BarActor {
 public:
  explicit BarActor(const tools::BarPlace& place);
  ~BarActor();
  /// Lays it by_mm beside its place.
  void shift(const Eigen::Vector3d& by_mm);
  vtkActor* actor() const { return actor_; }

 private:
  vtkNew<vtkActor> actor_;
  vtkNew<vtkTransform> transform_;
};

}  // namespace glisson::views
