// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/progress.h"
#include "retraction/simulate.h"
#include "study/rows.h"
#include "study/tradeoff.h"

namespace glisson::study {

/// Error against run time of the time schemes of a dynamic scene, on its own cells: implicit Euler, Newmark and
/// generalised alpha with steps of 4, 2, 1 and ½ of the scene's, at its end, against generalised alpha with steps of a
/// sixteenth. No motion is ended before, as each would come to rest at another time. points: LPS, mm. skipped: rows
/// that were not made, with the reason. Throws Cancelled.
std::vector<Row> timeSchemeRows(const retraction::Model& model, const retraction::Setup& setup,
                                const std::vector<Eigen::Vector3d>& points, const TradeoffOptions& options,
                                std::vector<std::string>& skipped, const Progress& progress = {});

}  // namespace glisson::study
