// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "image/volume.h"
#include "roi/contour_stack.h"

namespace glisson::elastography {

/// A region of interest on the grid of the elastogram, and how well the two fit.
struct MappedRoi {
  image::Mask mask;       ///< on the MRE grid
  double coverage = 0.0;  ///< fraction of the region's volume that lies inside the MRE volume, 0 ... 1
  double planeDistance_mm =
      0.0;  ///< largest distance of a slice of the region from the nearest MRE slice, along the MRE normal
  int coincidentSlices = 0;  ///< MRE slices filled from the polygons themselves
  int sampledSlices = 0;     ///< MRE slices filled from the voxel mask
  std::vector<std::string> warnings;
  Diagnostics diagnostics;  ///< of the outlines; those that are warnings are in warnings too
};

/// Polygons drawn on the MRI, on the MRE slices. Rule, for each MRE slice: where polygons lie in its plane (within 0.5
/// mm and 1 degree) the same polygons are rasterised on the MRE grid; otherwise every MRE voxel asks the MRI voxel that
/// holds its centre, in the mask rasterised on mriGrid. Without mriGrid, and where by this rule no MRE slice would be
/// met at all (few planes between two of them), the polygons nearest to an MRE slice are used up to half a slice away,
/// in their own in-plane position. Warnings: doubtful outlines (roi::outlineDoubts); without mriGrid, elastography
/// slices between outlined ones that hold no outline; other FrameOfReferenceUID (where both are known); slices of the
/// region more than half an MRE slice from the nearest MRE slice; less than 90 % of the region inside the MRE. Throws
/// BadInput where no voxel of the MRE is met, or the polygons cannot be rasterised.
MappedRoi mapRoi(const roi::ContourStack& contours, const std::optional<image::Grid>& mriGrid,
                 const image::Grid& mreGrid, const std::string& mreFrameOfReferenceUid = {});

/// A voxel mask on any grid: every MRE voxel asks the mask voxel that holds its centre. Throws BadInput where no voxel
/// of the MRE is met.
MappedRoi mapRoi(const image::Mask& roi, const image::Grid& mreGrid);

}  // namespace glisson::elastography
