// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "verbs.h"

namespace glisson::cli {

/// diagnostics[] as every verb prints it: {code, severity, text, arguments}. warnings: texts; those that no diagnostic
/// says get the code "remark" and the severity warning.
Json diagnosticsJson(const Diagnostics& diagnostics, const std::vector<std::string>& warnings = {});

/// With --strict: throws BadInput with the first of the warnings and errors (notes do not count) and their number.
/// warnings as above. Does nothing without --strict.
void refuseIfStrict(const Context& context, const Diagnostics& diagnostics,
                    const std::vector<std::string>& warnings = {});

}  // namespace glisson::cli
