// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// How the result was computed, as paragraphs that could stand in a paper: body, stiffness, supports, loads, model,
/// solver, comparison, each with the numbers that were used. Names no file.
std::vector<std::string> methodText(const Scene& scene, const RunResult& result);

}  // namespace glisson::pipeline::detail
