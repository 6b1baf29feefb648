// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace glisson::pacs::detail {

/// Largest identifier in an answer, in bytes: real ones have under 4,000, and what is this short cannot nest so deep
/// that parsing it would exhaust the stack.
inline constexpr std::size_t largestIdentifier = 32 * 1024;

/// Attributes of a query or an answer: tag (gggg << 16 | eeee) and text in UTF-8. The order of tags is kept.
using Keys = std::map<std::uint32_t, std::string>;

/// Keys as a data set in a plain transfer syntax. Values beyond ASCII are marked as UTF-8.
std::string encodedKeys(const Keys& keys, const std::string& transferSyntax);

/// The wanted attributes of an answer: UTF-8, several values parted by backslashes, without control characters, at most
/// 200 bytes each. Throws NetworkError where the bytes are no data set.
Keys decodedKeys(const std::string& bytes, const std::string& transferSyntax, const std::vector<std::uint32_t>& wanted);

/// Text that may be shown: valid UTF-8 without control characters, at most limit bytes.
std::string shown(const std::string& text, std::size_t limit);

}  // namespace glisson::pacs::detail
