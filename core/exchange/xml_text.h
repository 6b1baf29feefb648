#pragma once

#include <string>

namespace glisson::exchange {

/// Text for XML attributes and content: & < > " ' escaped, control characters left out.
std::string xmlEscaped(const std::string& text);

}  // namespace glisson::exchange
