// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace glisson {

/// Replaces a file as a whole: written beside it, synchronised, renamed, the folder synchronised. A failure at any
/// moment leaves the old file. Throws BadInput that names the file and the reason (full disk, no rights).
void writeAtomically(const std::filesystem::path& file, const std::string& text);

/// The whole file. Throws BadInput where it cannot be read or is larger than 256 MB.
std::string readWhole(const std::filesystem::path& file);

}  // namespace glisson
