// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "option_table.h"

namespace glisson::cli {

/// Manual pages (section 1) of the command line and of each of its verbs: file name, and text for man(1). The text
/// depends on the table and the version alone.
std::vector<std::pair<std::string, std::string>> manualPages(const VerbRow& program);

/// Completion of verbs, options and their values for bash.
std::string bashCompletion(const VerbRow& program);

}  // namespace glisson::cli
