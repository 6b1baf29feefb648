// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/reorient.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/resample.h"
#include "support/support.h"

namespace glisson::image {
namespace {

TEST(Reorient, EveryVoxelStaysWhereItLiesInThePatient) {
  const Mask f = test::letterF();
  ScalarVolume volume(f.grid);
  for (std::size_t n = 0; n < volume.values.size(); ++n) volume.values[n] = static_cast<float>(n);
  for (const std::array<int, 3>& axes : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 2, 0},
                                         std::array{2, 1, 0}, std::array{2, 0, 1}, std::array{1, 0, 2}}) {
    const ScalarVolume other = permuted(volume, axes);
    ASSERT_EQ(other.values.size(), volume.values.size());
    for (int k = 0; k < other.grid.size.z(); ++k)
      for (int j = 0; j < other.grid.size.y(); ++j)
        for (int i = 0; i < other.grid.size.x(); ++i) {
          const Eigen::Vector3d p = other.grid.indexToLps({1.0 * i, 1.0 * j, 1.0 * k});
          const auto voxel = voxelAt(volume.grid, p);
          ASSERT_TRUE(voxel);
          ASSERT_EQ(other.at(i, j, k), volume.at(*voxel));
        }
  }
}

TEST(Reorient, RefusesWhatIsNoPermutation) {
  EXPECT_THROW(permuted(test::letterF().grid, {0, 0, 2}), BadArgument);
  EXPECT_THROW(permuted(test::letterF().grid, {0, 1, 3}), BadArgument);
}

}  // namespace
}  // namespace glisson::image
