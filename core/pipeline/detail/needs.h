// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pipeline/scene.h"

namespace glisson::pipeline::detail {

/// What a scene needs, decided once: plan() tells it, run() does it.
struct Needs {
  explicit Needs(const Scene& scene);

  bool patient = false;    ///< DICOM or volumes, outlined
  bool mriValues = false;  ///< intensities, not only the grid
  bool mre = false;        ///< elastogram read, mapped, measured
  bool vessels = false;
  bool liverSurface = false;  ///< triangle surface
  bool map = false;           ///< a modulus map from a file
  bool meshfree = false;
  bool mass = false;  ///< mass matrix
  bool damping = false;
  bool timeSteps = false;
  bool newton = false;        ///< non-linear kinematics
  bool linearBeside = false;  ///< the linear answer too: what linear theory misses
  bool condensed = false;
  bool compare = false;
  bool discretisation = false;  ///< error in millimetres from a second grid
  bool strain = true;           ///< validity is printed with every result
  bool cellField = false;       ///< displacement at every cell
  bool pictures = false;
  bool report = false;
  bool sofa = false;
  bool retractor = false;
  bool rigidBar = false;  ///< the retractor is a body of its own
  bool ligaments = false;
  bool uncertainty = false;     ///< asked for, and offered
  bool followingLoads = false;  ///< loads that follow their faces
};

}  // namespace glisson::pipeline::detail
