// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tools/keymap.h"

namespace glisson::tools {
namespace {

TEST(Keymap, RowsStandInTheOrderOfTheCommands) {
  ASSERT_EQ(keyTable().size(), commandCount);
  for (std::size_t i = 0; i < commandCount; ++i) {
    EXPECT_EQ(static_cast<std::size_t>(keyTable()[i].command), i) << keyTable()[i].id;
    EXPECT_EQ(commandNamed(keyTable()[i].id), keyTable()[i].command);
    EXPECT_NE(std::string(keyTable()[i].what), "");
    EXPECT_NE(std::string(keyTable()[i].keys), "");
  }
  EXPECT_FALSE(commandNamed("no such command"));
}

TEST(Keymap, NoKeyMeansTwoThings) {
  std::map<std::string, std::string> seen;
  for (const KeyEntry& e : keyTable()) {
    std::istringstream keys(e.keys);
    for (std::string key; keys >> key;) {
      EXPECT_TRUE(seen.emplace(key, e.id).second) << key << " is both " << seen[key] << " and " << e.id;
    }
  }
}

TEST(Keymap, EveryGestureSaysSomethingInSomeState) {
  std::set<std::string> names;
  for (const GestureEntry& g : gestureTable()) {
    EXPECT_TRUE(names.insert(g.gesture).second);
    EXPECT_FALSE(std::string(g.idle).empty() && std::string(g.drawing).empty() && std::string(g.editing).empty());
  }
  EXPECT_EQ(names.size(), 10u);
}

}  // namespace
}  // namespace glisson::tools
