#pragma once

#include <filesystem>
#include <string>

namespace glisson::exchange {

/// Writes beside, synchronised, then renamed, so that a failure leaves the old file. Throws BadInput where the folder
/// cannot be written to.
void writeBytes(const std::filesystem::path& file, const std::string& bytes);

/// Text for XML attributes and content: & < > " ' escaped, control characters left out.
std::string xmlEscaped(const std::string& text);

/// Shortest decimal text that reads back to the same double; "nan" where not finite.
std::string number(double value);

}  // namespace glisson::exchange
