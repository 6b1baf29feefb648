// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "elastography/statistics.h"
#include "report/page.h"

namespace glisson::pipeline::detail {

/// What a reader answers for beside a mean stiffness, after the QIBA profile [qiba2022mre]: what was measured, what was
/// left out and why, the change that would be real, and what only the reader can see.
void readersChecklist(const elastography::Measurement& measurement, report::Page& page);

}  // namespace glisson::pipeline::detail
