#pragma once

#include <string>

#include "pipeline/run.h"

namespace glisson::pipeline::detail {

/// The run record of contract.md as JSON text: results, solver history, every parameter with its unit, SHA-256 of the
/// inputs, version, seed. No user, host or path.
std::string runRecord(const Scene& scene, const RunResult& result);

}  // namespace glisson::pipeline::detail
