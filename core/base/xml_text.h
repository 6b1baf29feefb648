// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace glisson {

/// Text for attributes and content of XML, SVG and HTML: & < > " ' escaped; line ends and tabs become spaces, other
/// control characters are left out.
std::string xmlEscaped(const std::string& text);

}  // namespace glisson
