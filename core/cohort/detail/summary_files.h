// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cohort/detail/summary.h"

namespace glisson::cohort::detail {

/// patients.csv: one row of figures for each patient; a cell is empty where the figure is not known.
std::string patientsCsv(const Summary& summary);

/// rejected.csv: who was left out, and why.
std::string rejectedCsv(const Summary& summary);

/// cohort.json, schema glisson/cohort/1.
std::string summaryJson(const Summary& summary);

}  // namespace glisson::cohort::detail
