// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "anatomy/surface_file.h"

namespace glisson::anatomy::detail {

/// Throws BadInput: that file is not a usable surface, and why.
[[noreturn]] void refuseSurface(const std::filesystem::path& path, const std::string& why);

/// Each reads one format as it is written: repeated points are kept, indices checked, coordinates not.
SurfaceFile readObj(const std::filesystem::path& path);
SurfaceFile readStl(const std::filesystem::path& path);   ///< ASCII or binary
SurfaceFile readGmsh(const std::filesystem::path& path);  ///< versions 1 and 2, ASCII
/// Throws BadInput where a legacy VTK file announces more than it can hold, or is no surface or volume mesh.
void checkLegacyVtk(const std::filesystem::path& path);

SurfaceFile readVtk(const std::filesystem::path& path, bool xml, bool volume);

}  // namespace glisson::anatomy::detail
