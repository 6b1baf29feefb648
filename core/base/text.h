// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace glisson {

/// ASCII capitals become small letters; other bytes (UTF-8) and the locale play no part.
inline std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// The last extension of a file's name with its dot, in small letters: ".gz" of "Liver.NII.GZ".
inline std::string extensionOf(const std::filesystem::path& file) {
  return lowerCase(file.extension().string());
}

}  // namespace glisson
