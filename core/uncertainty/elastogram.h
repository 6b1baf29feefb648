// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "elastography/stiffness_map.h"
#include "image/volume.h"

namespace glisson::uncertainty {

/// What a stiffness map says about its own scatter, as standard deviations of the ln of the modulus.
struct MapScatter {
  double noise = 0.0;  ///< of a voxel, for noise that is correlated over a given length
  double liver = 0.0;  ///< of the trusted voxels about their mean: how far one place stands for another
};

/// From trusted voxels (in roi, where it is not null; on the map's grid). noise: from the median difference of pairs in
/// a slice that lie correlation_mm apart along a row or column: an upper limit, as true differences over that distance
/// count as noise. Held between .02 and .5.
MapScatter scatterOf(const elastography::StiffnessMap& map, const image::Mask* roi, double correlation_mm);

/// A measured modulus on the cells of a model.
struct Elastogram {
  double noise = 0.0;  ///< of a cell's ln modulus
  double liver = 0.0;  ///< further, where the cell's value was filled in from elsewhere
  image::Mask origin;  ///< on the model's grid: 0 outside, 1 measured, 2 filled in
};

}  // namespace glisson::uncertainty
