// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace glisson {

/// Version of the software as released, e.g. "0.1.0".
std::string version();

/// Commit that was built, short hash with "-dirty" where the tree had changes; "unknown" outside a checkout.
std::string buildCommit();

/// The line that stands on every exported picture and report.
inline constexpr const char* researchUseOnly = "Research use only, not for clinical use";

}  // namespace glisson
