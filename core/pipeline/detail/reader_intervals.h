// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "elastography/statistics.h"
#include "image/volume.h"
#include "pipeline/readers.h"

namespace glisson::pipeline::detail {

/// Overlap and volumes of two readers, by bootstrap over the slices that either has outlined.
void addOverlapIntervals(const image::Mask& a, const image::Mask& b, ReaderIntervals& out);

/// Mean stiffness of b less that of a, by bootstrap over the slices that either has measured: both readers' voxels of a
/// slice are drawn together, so that what they share cancels.
elastography::Interval stiffnessDifference(const elastography::Measurement& a, const elastography::Measurement& b);

}  // namespace glisson::pipeline::detail
