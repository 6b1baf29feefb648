// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/support.h"

#include <unistd.h>

#include <atomic>
#include <cstdlib>

namespace glisson::test {

std::filesystem::path sharedData() {
  if (const char* folder = std::getenv("GLISSON_SHARED_DATA")) return folder;
  return GLISSON_SHARED_DATA;
}

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> count{0};
  path_ = std::filesystem::temp_directory_path() /
          ("glisson-test-" + std::to_string(getpid()) + "-" + std::to_string(count++));
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

image::Mask letterF() {
  image::Grid g;
  g.size = {20, 26, 9};
  g.spacing_mm = {1.6, 2.1, 5.0};
  g.origin_lps_mm = {-37.0, 12.5, 101.0};
  g.direction = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitX()))
                    .toRotationMatrix();
  image::Mask mask(g);
  for (int k = 1; k < 8; ++k)
    for (int j = 3; j < 23; ++j)
      for (int i = 3; i < 17; ++i) {
        const bool stem = i < 7;
        const bool top = j < 7 && i < 17 - (k > 4 ? 3 : 0);
        const bool middle = j >= 11 && j < 15 && i < 13;
        if (stem || top || middle) mask.at(i, j, k) = 1;
      }
  return mask;
}

}  // namespace glisson::test
