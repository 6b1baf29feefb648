// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "study/rows.h"
#include "verbs.h"

namespace glisson::cli {

/// rows[] as every reader of the studies expects them; numbers that do not exist are null.
Json toJson(const std::vector<study::Row>& rows);

}  // namespace glisson::cli
