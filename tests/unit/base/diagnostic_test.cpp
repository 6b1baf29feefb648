// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/diagnostic.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"

namespace glisson {
namespace {

TEST(Diagnostic, FillsItsArgumentsIntoTheText) {
  const Diagnostic d{DiagnosticCode::DifferenceWithheld,
                     {{"stiffness", std::string("atlas")}, {"reason", std::string("slips")}}};
  EXPECT_EQ(d.text(), "no difference is given: the run with the atlas stiffness is no answer (slips)");
  EXPECT_EQ(d.severity(), Severity::Error);
  EXPECT_EQ(nameOf(d.code), "difference-withheld");
}

TEST(Diagnostic, RefusesATextWhoseArgumentIsMissing) {
  const Diagnostic d{DiagnosticCode::DifferenceWithheld, {}};
  EXPECT_THROW(d.text(), BadArgument);
}

TEST(Diagnostic, EveryCodeHasANameOfItsOwn) {
  std::set<std::string_view> names;
  int count = 0;
#define GLISSON_DIAGNOSTIC(code, name, severity, text) \
  names.insert(nameOf(DiagnosticCode::code));          \
  ++count;
#include "base/diagnostics.def"
#undef GLISSON_DIAGNOSTIC
  EXPECT_EQ(static_cast<int>(names.size()), count);
}

TEST(Diagnostics, KeepOrderAndSelectBySeverity) {
  Diagnostics all;
  EXPECT_TRUE(all.empty());
  all.add(DiagnosticCode::DifferenceWithheld, {{"stiffness", std::string("own")}, {"reason", std::string("slips")}});
  EXPECT_TRUE(all.contains(DiagnosticCode::DifferenceWithheld));
  EXPECT_FALSE(all.contains(DiagnosticCode::RetractorSlips));
  EXPECT_EQ(all.texts(Severity::Error).size(), 1u);
}

}  // namespace
}  // namespace glisson
