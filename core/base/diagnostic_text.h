// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"

namespace glisson {

/// The English text of a code as it stands in the table, with {arguments} that are not filled in.
std::string_view templateOf(DiagnosticCode code);

/// A text of the table in any language, with the diagnostic's values in place of the {arguments} that it names; numbers
/// with four significant digits. Throws BadArgument if it names one that is not there.
std::string filledIn(std::string_view text, const Diagnostic& diagnostic);

}  // namespace glisson
