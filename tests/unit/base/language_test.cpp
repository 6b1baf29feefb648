// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/language.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "base/error.h"

namespace glisson {
namespace {

TEST(Language, NamesGoThereAndBack) {
  for (const Language language : {Language::English, Language::German})
    EXPECT_EQ(languageNamed(nameOf(language)), language);
  EXPECT_EQ(languageNamed(""), Language::English);
}

TEST(Language, APhraseTakesItsValuesInOrder) {
  EXPECT_EQ(phrase("@ to @ mm", Language::English, {"1", "2"}), "1 to 2 mm");
  EXPECT_EQ(phrase("@ to @ mm", Language::German, {"1", "2"}), "1 bis 2 mm");
  EXPECT_THROW(phrase("@ to @ mm", Language::German, {"1"}), BadArgument);
  EXPECT_THROW(phrase("bar", Language::German, {"1"}), BadArgument);
  EXPECT_THROW(phrase("a text that nobody has translated", Language::English), BadArgument);
}

TEST(Language, EveryTextHasItsOwnKeyGermanAndAsManyValues) {
  const struct {
    const char *english, *german;
  } texts[] = {
#include "base/german.inc"
  };
  std::set<std::string> keys;
  for (const auto& [english, german] : texts) {
    const std::string a = english, b = german;
    EXPECT_TRUE(keys.insert(a).second) << a;
    EXPECT_NE(a, b);
    EXPECT_EQ(std::count(a.begin(), a.end(), '@'), std::count(b.begin(), b.end(), '@')) << a;
  }
}

TEST(Language, GermanNumbersHaveAComma) {
  EXPECT_EQ(inLanguage("7.25", Language::German), "7,25");
  EXPECT_EQ(inLanguage("7.25", Language::English), "7.25");
}

}  // namespace
}  // namespace glisson
