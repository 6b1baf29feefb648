// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace glisson {

/// The one place where the axes flip. Everything inside is LPS (x to the patient's left, y to posterior, z to
/// superior: DICOM's patient frame); NIfTI and some research formats speak RAS. Works on points and directions.
inline Eigen::Vector3d lpsToRas(const Eigen::Vector3d& v_lps) {
  return {-v_lps.x(), -v_lps.y(), v_lps.z()};
}

/// Inverse of lpsToRas.
inline Eigen::Vector3d rasToLps(const Eigen::Vector3d& v_ras) {
  return {-v_ras.x(), -v_ras.y(), v_ras.z()};
}

}  // namespace glisson
