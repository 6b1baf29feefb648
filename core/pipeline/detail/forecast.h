// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pipeline/detail/needs.h"
#include "pipeline/scene.h"

namespace glisson::pipeline::detail {

/// The body before it is built.
struct BodySize {
  double voxels = 0.0;
  double volume_mm3 = 0.0;
  double surface_mm2 = 0.0;
};

/// Frames of a mesh-free model that the voxels have room for, and what they are, in words.
struct FramesForecast {
  int count = 0;
  double dofs = 0.0;
  std::string why;
};

/// What a scene will come to: sizes, and with them time and memory. From the scene's files only a mask is read.
/// Throws BadInput where the mask cannot be read.
struct Forecast {
  explicit Forecast(const Scene& scene);

  const Scene& scene;
  Needs needs;
  BodySize body;
  bool tetrahedra = false;  ///< the model is tetrahedra
  bool assembled = false;   ///< a stiffness matrix is put together
  FramesForecast frames;
  double cells = 0.0;
  double dofs = 0.0;
  double solve_s = 0.0;   ///< one linear solve
  double solve_MB = 0.0;  ///< its vectors and hierarchy
  double answers = 1.0;   ///< 2 where the scene compares two stiffnesses
};

}  // namespace glisson::pipeline::detail
