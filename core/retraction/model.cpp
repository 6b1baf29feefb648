// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "retraction/simulate.h"

namespace glisson::retraction {

Model makeModel(image::ScalarVolume youngs_kPa, double poisson, Density density, bool checkSize) {
  const image::Grid& g = youngs_kPa.grid;
  Model m;
  Eigen::Vector3i low = g.size, high = Eigen::Vector3i::Constant(-1);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        const float E = youngs_kPa.at(i, j, k);
        if (E == 0.0f) continue;
        if (!std::isfinite(E) || E < 0.0f || E > 1e12f) {
          std::ostringstream text;
          text << "the Young's modulus of voxel (" << i << ", " << j << ", " << k << ") in slice " << k << " is " << E
               << " kPa; it must be a positive number";
          throw BadInput(text.str());
        }
        ++m.cells;
        const Eigen::Vector3i c(i, j, k);
        low = low.cwiseMin(c);
        high = high.cwiseMax(c);
      }
  if (m.cells == 0) throw BadInput("the body holds no voxel; check the mask and its label");
  if (checkSize) {
    const Eigen::Vector3d extent_mm = (high - low + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(g.spacing_mm);
    if (extent_mm.maxCoeff() < 30.0 || extent_mm.maxCoeff() > 600.0) {
      std::ostringstream text;
      text << "the liver is " << extent_mm.maxCoeff() << " mm long; one between 30 and 600 mm is expected: check the "
           << "units of the image and the region of interest";
      throw BadInput(text.str());
    }
  }
  m.volume_mL = 1e-3 * static_cast<double>(m.cells) * g.voxelVolume_mm3();
  m.mass_kg = 1e-6 * m.volume_mL * density.kgPerM3();
  m.poisson = poisson;
  m.density = density;
  m.youngs_kPa = std::move(youngs_kPa);
  return m;
}

}  // namespace glisson::retraction
