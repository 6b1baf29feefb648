// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace glisson::exchange {

/// Writes a file beside its final name and renames it, so that nothing half-written is ever found; makes the folder.
/// Throws BadInput naming the file (not its folder) where the disk is full or the folder cannot be written.
void writeTextFile(const std::filesystem::path& file, const std::string& text);
void writeTextFile(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// Shortest decimal form that reads back as the same double; independent of the locale.
std::string shortest(double value);

}  // namespace glisson::exchange
