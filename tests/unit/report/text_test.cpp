// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace glisson::report {
namespace {

TEST(Csv, QuotesOnlyWhereNeeded) {
  Csv csv({"a", "b"});
  csv.row({"1.5", "say \"x\", y"});
  EXPECT_EQ(csv.text(), "a,b\n1.5,\"say \"\"x\"\", y\"\n");
  EXPECT_THROW(csv.row({"only one"}), BadArgument);
}

TEST(Number, FewDigitsAndNoNan) {
  EXPECT_EQ(number(3.14159), "3.142");
  EXPECT_EQ(number(std::nan("")), "not available");
}

}  // namespace
}  // namespace glisson::report
