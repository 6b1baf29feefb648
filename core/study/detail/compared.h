// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "retraction/simulate.h"
#include "study/rows.h"

namespace glisson::study {

/// "1,234 cells of 3.28 mm".
std::string cellsText(const retraction::Model& model);

/// The errors of displacements (mm) against those of a reference at the same places; places that are not finite are
/// outside the body and are counted in the note. The tip is where the reference moves most.
void compare(Row& row, const std::vector<Eigen::Vector3d>& u, const std::vector<Eigen::Vector3d>& reference);

}  // namespace glisson::study
