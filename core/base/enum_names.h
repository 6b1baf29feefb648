// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace glisson {

/// The words of an enumeration in files and on the command line, each once: readers, writers and messages take them
/// from the same table.
template <class E, std::size_t count>
class EnumNames {
 public:
  constexpr explicit EnumNames(const std::array<std::pair<std::string_view, E>, count>& names) : names_(names) {}

  /// Throws BadArgument on a value without a name.
  std::string nameOf(E value) const {
    for (const auto& [name, named] : names_)
      if (named == value) return std::string(name);
    throw BadArgument("a value of an enumeration has no name");
  }
  /// Throws BadInput with the words that there are.
  E named(std::string_view word) const {
    for (const auto& [name, value] : names_)
      if (name == word) return value;
    std::string known;
    for (const auto& [name, value] : names_) known += (known.empty() ? "" : ", ") + std::string(name);
    throw BadInput("\"" + std::string(word.substr(0, 40)) + "\" is not known; it must be one of: " + known);
  }
  /// In the order of the table.
  std::vector<std::string> words() const {
    std::vector<std::string> out;
    for (const auto& [name, value] : names_) out.emplace_back(name);
    return out;
  }

 private:
  std::array<std::pair<std::string_view, E>, count> names_;
};

/// EnumNames of the rows given.
template <class E, std::size_t count>
constexpr EnumNames<E, count> enumNames(const std::pair<std::string_view, E> (&rows)[count]) {
  return EnumNames<E, count>(std::to_array(rows));
}

}  // namespace glisson
