// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "image/grid.h"

namespace glisson::tools {

/// Planes of the patient, as radiologists look at them.
enum class PatientPlane { Axial, Coronal, Sagittal };

/// The plane that the slices of a grid are nearest to.
PatientPlane planeOf(const image::Grid& grid);

/// The axes of the grid that run along columns, rows and slices of a reformat in this plane (image/reorient.h): left to
/// right or front to back along a row, and down a column, up to their sign.
std::array<int, 3> axesOf(PatientPlane plane, const image::Grid& grid);

/// The two planes that cross the slices of a grid.
std::array<PatientPlane, 2> planesAcross(const image::Grid& grid);

}  // namespace glisson::tools
