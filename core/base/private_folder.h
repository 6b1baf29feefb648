// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace glisson {

/// A folder below the system's temporary one that only this user may enter (mode 0700), removed with everything in it
/// by the destructor; where the program is killed, by the next one that makes such a folder.
class PrivateFolder {
 public:
  /// Throws BadInput where no temporary folder can be made.
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< held while the folder is in use
};

}  // namespace glisson
