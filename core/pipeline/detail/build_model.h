// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/inputs.h"
#include "pipeline/scene.h"
#include "retraction/simulate.h"
#include "retraction/smooth_body.h"

namespace glisson::pipeline::detail {

/// Cells of the body: the box's, the mask's own voxels, or the mask resampled to cell_mm. For a patient the default
/// cell is a cube of two MRI pixels. Resampled cells are filled where half of them is covered, and at the surface so
/// that the volume is the mask's (image::resampleKeepingVolume). Empty margins are cut away.
image::Mask bodyCells(const Scene& scene, const Inputs& inputs);

/// The smooth body behind the cells, from the finest voxels of the region of interest; null for boxes and for scenes
/// without a retractor. For both models: compute once.
std::shared_ptr<const retraction::SmoothBody> smoothBody(const Scene& scene, const Inputs& inputs);

/// The body with the scene's own material. Throws BadInput (moduli not positive: voxel and slice).
retraction::Model buildModel(const Scene& scene, const Inputs& inputs, const image::Mask& cells);

/// The same body with the textbook modulus.
retraction::Model buildAtlasModel(const Scene& scene, const image::Mask& cells);

/// True where both give every cell the same modulus to the precision that a 32-bit map holds (2e-7, relative).
bool sameStiffness(const retraction::Model& a, const retraction::Model& b);

/// Removes pieces that nothing holds where they are together less than 1 % of the volume, and says so in warnings;
/// larger ones stay (and are refused by the solver with a reason).
image::Mask dropLooseIslands(const Scene& scene, const image::Mask& cells, std::vector<std::string>& warnings);

}  // namespace glisson::pipeline::detail
