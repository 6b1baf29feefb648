// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace glisson::pipeline::detail {

/// Every step that the software knows, in the order in which plan() lists them: the place of a step in a plan.
enum class StepId {
  ReadMri,
  ReadRoi,
  ReadMre,
  MeasureStiffness,
  ReadMap,
  Vessels,
  LiverSurface,
  Mesh,
  PlaceBar,
  Capsule,
  Ligaments,
  LoadsThatFollow,
  AssembledStiffnessMatrix,
  MeshFreeFrames,
  MassMatrix,
  Damping,
  Solve,
  TimeSteps,
  LargeDeformation,
  LinearSolve,
  CondensedResponse,
  AtlasSolve,
  DiscretisationError,
  Difference,
  Uncertainty,
  LinearGap,
  Strain,
  CellDisplacements,
  WriteDisplacementField,
  PictureData,
  SliceOverlay,
  Overlay3D,
  UncertaintyPictures,
  Report,
  Sofa
};

constexpr std::size_t stepCount = static_cast<std::size_t>(StepId::Sofa) + 1;

/// As plans and records name it: "read-mri", "place-bar", "atlas-solve", ...
const char* nameOf(StepId step);

}  // namespace glisson::pipeline::detail
