// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace glisson {

/// SHA-256 of bytes, as 64 lower-case hexadecimal digits.
std::string sha256(const void* bytes, std::size_t count);

/// HMAC [RFC 2104] over SHA-256 of a text, as 64 lower-case hexadecimal digits. key: its bytes.
std::string hmacSha256(const std::string& key, const std::string& text);

/// SHA-256 of a file. Throws BadInput where it cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace glisson
