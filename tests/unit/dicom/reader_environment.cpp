// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "dicom/series.h"

namespace glisson::dicom {
namespace {

/// Tests use the reader program of their own build.
class UseReader : public testing::Environment {
 public:
  void SetUp() override { setReaderProgram(GLISSON_READER); }
};

[[maybe_unused]] const testing::Environment* const registered = testing::AddGlobalTestEnvironment(new UseReader);

}  // namespace
}  // namespace glisson::dicom
