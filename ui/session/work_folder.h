// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace glisson::session {

/// A folder of this window alone, for what it runs: two windows never write over each other. It goes with its window;
/// what a killed one left is cleared away at a later start.
class WorkFolder {
 public:
  /// Makes current-case-<process>-<n> below the folder, locked while it lives. Throws BadInput where that cannot be
  /// written.
  explicit WorkFolder(const std::filesystem::path& below);
  ~WorkFolder();  ///< removes it with all that is in it
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Removes the work folders whose program is gone. Returns how many.
  static int removeAbandoned(const std::filesystem::path& below);

 private:
  std::filesystem::path path_, lock_;
  int fd_ = -1;
};

}  // namespace glisson::session
