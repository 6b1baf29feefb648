// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "image/volume.h"

namespace glisson::test {

/// Folder of real data beside the checkout (environment variable GLISSON_SHARED_DATA overrides). May not exist:
/// use GLISSON_NEEDS_DATA in a test.
std::filesystem::path sharedData();

/// A fresh empty folder that is removed when the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The asymmetric phantom: a solid letter F drawn in i-j, thicker with k, on an oblique anisotropic grid, so that any
/// flip, transpose or shift is seen. 1 inside, 0 outside.
image::Mask letterF();

}  // namespace glisson::test

/// Skips the running GoogleTest with a message where the real data is absent.
#define GLISSON_NEEDS_DATA(relative)                                        \
  if (!std::filesystem::exists(::glisson::test::sharedData() / (relative))) \
  GTEST_SKIP() << "real data '" << (relative) << "' is not beside this checkout"
