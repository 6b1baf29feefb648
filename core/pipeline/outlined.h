// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "dicom/series.h"

namespace glisson::pipeline {

/// A plane of an outline (a contour, a frame of a segmentation) and the image that it says it was drawn on.
struct NamedPlane {
  Eigen::Vector3d point_lps_mm = Eigen::Vector3d::Zero();
  std::string sopInstanceUid;
};

/// What an outline says that it was drawn on; empty where it names nothing.
struct OutlineNames {
  std::string seriesUid{};
  std::vector<NamedPlane> planes{};

  bool empty() const { return seriesUid.empty() && planes.empty(); }
};

/// The series that was outlined, by the images that the outline names and else by the series that it names; -1 where
/// it is not in the scan. said (null: nobody is told): where the two contradict each other.
int outlinedSeries(const dicom::ScanResult& scan, const OutlineNames& names, Diagnostics* said = nullptr);

/// The series to take as the image (role anatomical) or the elastogram (role stiffness): set by hand; else what was
/// outlined (of an elastogram: the stiffness of the acquisition that was outlined); else the best of that role, or the
/// only series there is. mayBeUneven: one whose slices lie unevenly can be taken as what was outlined. Throws BadInput
/// as dicom::findRole does.
const dicom::Series& seriesFor(const dicom::ScanResult& scan, dicom::SeriesRole role, const OutlineNames& names,
                               Diagnostics& said, bool mayBeUneven = false);

/// Planes that do not lie on the image that they name, by more than half a millimetre. what: "contours", "frames".
Diagnostics planesOffTheirImages(const OutlineNames& names, const std::vector<const dicom::ScanResult*>& scans,
                                 const std::string& what);

}  // namespace glisson::pipeline
