// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "dicom/series.h"

namespace glisson::dicom {

/// Guesses what the volumes of one SeriesInstanceUID are for, each by what its own images say, and sets role,
/// roleReason and (where the vendor or the description says so) unit.
void setRoles(std::vector<Series>& volumes);

/// Whether its role was set by hand (applyRoles).
bool setByHand(const Series& series);

}  // namespace glisson::dicom
