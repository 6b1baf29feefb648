// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "commands/outlines.h"
#include "image/grid.h"

namespace glisson::session {

/// The outlines as they are measured: slices of the elastogram that carry the mark "no reliable wave" are left out by
/// an exclusion that covers each MRI slice lying in them. Written beside a case, so that the command line measures the
/// same voxels.
inline commands::Outlines measuredContours(const commands::Outlines& outlines, const image::Grid& mri,
                                           const image::Grid& mre) {
  constexpr double beyond_mm = 1000.0;
  commands::Outlines measured = outlines;
  const auto mreSlice = [&](int k) {
    const Eigen::Vector3d centre = mri.indexToLps({0.5 * mri.size.x(), 0.5 * mri.size.y(), 1.0 * k});
    return static_cast<int>(std::lround(mre.lpsToIndex(centre).z()));
  };
  for (int k = 0; k < mri.size.z(); ++k) {
    bool left = false;
    for (const auto& [marked, mark] : outlines.marks)
      left = left || (mark == commands::SliceMark::NoWave && mreSlice(marked) == mreSlice(k));
    if (!left) continue;
    const double i = beyond_mm / mri.spacing_mm.x(), j = beyond_mm / mri.spacing_mm.y();
    roi::Polygon all;
    all.exclude = true;
    all.points_lps_mm.resize(3, 4);
    all.points_lps_mm << mri.indexToLps({-i, -j, 1.0 * k}), mri.indexToLps({mri.size.x() + i, -j, 1.0 * k}),
        mri.indexToLps({mri.size.x() + i, mri.size.y() + j, 1.0 * k}), mri.indexToLps({-i, mri.size.y() + j, 1.0 * k});
    measured.polygons.push_back(std::move(all));
  }
  return measured;
}

}  // namespace glisson::session
