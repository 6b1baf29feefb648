// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/manufactured.h"

#include <gtest/gtest.h>

#include "base/error.h"

using namespace glisson;
using namespace glisson::study;

TEST(Manufactured, ErrorFallsWithSecondOrder) {
  for (const auto& [kind, cells] : {std::pair{Manufactured::VaryingModulus, 8}, {Manufactured::FiniteStrain, 6}}) {
    const ManufacturedResult r = solveManufactured(kind, cells);
    SCOPED_TRACE(r.what);
    EXPECT_TRUE(r.converged);
    EXPECT_EQ(r.fine, 2 * r.coarse);
    EXPECT_GT(r.order, 1.8);
    EXPECT_LT(r.order, 2.4);
    EXPECT_LT(r.fineError, 0.05);
  }
}

TEST(Manufactured, RefusesCellsThatHaveNoMiddle) {
  EXPECT_THROW(solveManufactured(Manufactured::VaryingModulus, 5), BadArgument);
  EXPECT_THROW(solveManufactured(Manufactured::VaryingModulus, 2), BadArgument);
}
