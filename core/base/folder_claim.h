// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace glisson {

/// While it lives, no other claim to the folder is given, in this program or another on this computer. Leaves nothing
/// behind, whatever becomes of the program.
class FolderClaim {
 public:
  /// Throws BadInput where another one holds it. A folder that cannot be locked (some network drives) counts as
  /// claimed.
  explicit FolderClaim(const std::filesystem::path& folder);
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace glisson
