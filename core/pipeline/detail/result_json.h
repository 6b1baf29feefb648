// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "pipeline/scene.h"
#include "retraction/simulate.h"

namespace glisson::pipeline::detail {

/// A vector as JSON, components that are not finite as null.
nlohmann::ordered_json vectorToJson(const Eigen::Vector3d& v);

/// {code, severity, text, arguments}
nlohmann::ordered_json diagnosticToJson(const Diagnostic& diagnostic);

/// One answer as run.json holds it, for the scene's own stiffness at its top and for the second under "atlas".
nlohmann::ordered_json resultToJson(const retraction::Result& result, const Scene& scene);

}  // namespace glisson::pipeline::detail
