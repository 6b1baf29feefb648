// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/map_unit.h"

#include <gtest/gtest.h>

namespace glisson {
namespace {

TEST(MapUnit, ReadsWhatFilesWrite) {
  const auto kPa = [](const char* text) { return mapUnit(text).value_or(MapUnit{MapUnit::Of::Speed, -1.0}); };
  for (const auto& [text, factor] : {std::pair("Pa", 1e-3), std::pair("kPa", 1.0), std::pair("KPA", 1.0),
                                     std::pair("N/m2", 1e-3), std::pair("kilopascal", 1.0), std::pair("MPa", 1e3),
                                     std::pair("mPa", 1e-6), std::pair("0.01kPa", 0.01), std::pair("2 Pa", 2e-3)}) {
    EXPECT_EQ(kPa(text).of, MapUnit::Of::Modulus) << text;
    EXPECT_DOUBLE_EQ(kPa(text).factor, factor) << text;
  }
  EXPECT_EQ(mapUnit("m/s")->of, MapUnit::Of::Speed);
  EXPECT_DOUBLE_EQ(mapUnit("mm/s")->factor, 1e-3);
  for (const char* none : {"", "US", "1", "%", "mm2/s", "normalized", "-1kPa", "0 kPa", "kPa/s"})
    EXPECT_FALSE(mapUnit(none)) << none;
}

TEST(MapUnit, HasOneWordForEach) {
  EXPECT_EQ(canonicalUnit("N/m2"), "Pa");
  EXPECT_EQ(canonicalUnit("kilopascal"), "kPa");
  EXPECT_EQ(canonicalUnit("MPa"), "1000kPa");
  EXPECT_EQ(canonicalUnit("cm/s"), "0.01m/s");
  EXPECT_EQ(canonicalUnit("mm2/s"), "mm2/s");
  for (const char* text : {"N/m2", "kilopascal", "MPa", "cm/s", "0.01kPa"})
    EXPECT_DOUBLE_EQ(mapUnit(canonicalUnit(text))->factor, mapUnit(text)->factor);
}

}  // namespace
}  // namespace glisson
