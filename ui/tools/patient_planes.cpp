// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/patient_planes.h"

#include <algorithm>
#include <cmath>

namespace glisson::tools {

namespace {

/// The axis of the grid for each axis of the patient (left-right, front-back, foot-head), no two the same: of all ways
/// the one whose directions fit best.
std::array<int, 3> axesAlongPatient(const image::Grid& grid) {
  std::array<int, 3> axes{0, 1, 2}, best = axes;
  double fit = -1.0;
  do {
    double here = 0.0;
    for (int p = 0; p < 3; ++p) here += std::abs(grid.direction(p, axes[static_cast<std::size_t>(p)]));
    if (here > fit + 1e-9) fit = here, best = axes;
  } while (std::next_permutation(axes.begin(), axes.end()));
  return best;
}

}  // namespace

PatientPlane planeOf(const image::Grid& grid) {
  const std::array<int, 3> along = axesAlongPatient(grid);
  return along[2] == 2 ? PatientPlane::Axial : along[1] == 2 ? PatientPlane::Coronal : PatientPlane::Sagittal;
}

std::array<int, 3> axesOf(PatientPlane plane, const image::Grid& grid) {
  const auto [x, y, z] = axesAlongPatient(grid);
  switch (plane) {
    case PatientPlane::Axial: return {x, y, z};
    case PatientPlane::Coronal: return {x, z, y};
    case PatientPlane::Sagittal: break;
  }
  return {y, z, x};
}

std::array<PatientPlane, 2> planesAcross(const image::Grid& grid) {
  switch (planeOf(grid)) {
    case PatientPlane::Axial: return {PatientPlane::Coronal, PatientPlane::Sagittal};
    case PatientPlane::Coronal: return {PatientPlane::Axial, PatientPlane::Sagittal};
    case PatientPlane::Sagittal: break;
  }
  return {PatientPlane::Axial, PatientPlane::Coronal};
}

}  // namespace glisson::tools
