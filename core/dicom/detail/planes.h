// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "dicom/detail/image_header.h"
#include "dicom/series.h"

namespace glisson::dicom::detail {

/// Two images nearer than this lie at one position.
inline constexpr double samePlace_mm = 0.01;

/// One slice on its way into a volume.
struct Plane {
  const ImageHeader* header = nullptr;
  const Frame* frame = nullptr;
  double along_mm = 0.0;  ///< position · normal
};
using Planes = std::vector<Plane>;

/// The file that holds it, and its frame where there are several.
std::string nameOf(const Plane& plane);
/// The first three, and how many more.
std::string namesOf(const Planes& planes);

/// Sets the series' spacing along the normal, or the error that says why there is none. planes: at least one, in order
/// of along_mm, of one geometry; the series' grid is that of the first.
void spaceSlices(const Planes& planes, const Eigen::Vector3d& normal, Series& series);

}  // namespace glisson::dicom::detail
