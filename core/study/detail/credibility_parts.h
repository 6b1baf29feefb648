// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "study/credibility.h"

namespace glisson::study {

/// Lines of the page.
using Lines = std::vector<Evidence>;

/// The parts of the page; each computes what it says. Throw what their computations throw.
Lines statedContext();
Lines manufacturedLines(const CredibilityOptions& options, const Progress& progress);
Lines beamLines(const CredibilityOptions& options, const Progress& progress);
Lines contactLines(const CredibilityOptions& options, const Progress& progress);
Lines stabilityLines(const CredibilityOptions& options, const Progress& progress);
/// One synthetic patient: what was measured against its truth, cells, solver, balance; how sure; what linear theory
/// would miss.
Lines patientLines(const CredibilityOptions& options, const Progress& progress);
Lines statedValidation();
Lines statedApplicability();

}  // namespace glisson::study
