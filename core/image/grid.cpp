// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/grid.h"

#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::image {

void Grid::check() const {
  std::ostringstream why;
  if ((size.array() < 1).any()) {
    why << "the image has " << size.transpose() << " voxels along its axes; each must be at least 1";
  } else if (static_cast<double>(size.x()) * size.y() * size.z() > 2147483648.0) {
    why << "the image has " << size.transpose() << " voxels, more than 2^31; crop or resample it";
  } else if (!spacing_mm.allFinite() || (spacing_mm.array() <= 0.0).any() || (spacing_mm.array() > 1e4).any()) {
    why << "the voxel spacing is " << spacing_mm.transpose() << " mm; each must be a positive number";
  } else if (!origin_lps_mm.allFinite() || origin_lps_mm.cwiseAbs().maxCoeff() > 1e6) {
    why << "the image position is " << origin_lps_mm.transpose() << " mm, which is no place in a scanner";
  } else if (!direction.allFinite() ||
             (direction.transpose() * direction - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-4) {
    why << "the image axes are not orthogonal unit vectors (sheared or scaled orientation); resample it to a regular "
           "grid";
  } else {
    return;
  }
  throw BadInput(why.str());
}

bool Grid::sameGeometry(const Grid& other, double tolerance_mm) const {
  if (size != other.size) return false;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d index((corner & 1) ? size.x() - 1 : 0, (corner & 2) ? size.y() - 1 : 0,
                                (corner & 4) ? size.z() - 1 : 0);
    if ((indexToLps(index) - other.indexToLps(index)).norm() > tolerance_mm) return false;
  }
  return true;
}

}  // namespace glisson::image
