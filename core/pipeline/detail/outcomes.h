#pragma once

#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// Adds to r.diagnostics how the bars and solves of both stiffnesses ended, if not as asked for, and where the bar was laid.
void tellOfOutcomes(RunResult& r);

}  // namespace glisson::pipeline::detail
