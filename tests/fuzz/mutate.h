// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "base/random.h"

namespace glisson::test {

/// A file with random damage: bytes changed, lengths and counts made extreme, pieces cut out, doubled or moved, the end
/// missing. The same random numbers give the same damage.
inline std::string mutated(std::string file, Random& random) {
  if (file.size() < 16) return file;
  // Most of what a parser trusts stands in the first kilobytes.
  const auto place = [&] {
    const std::uint64_t near = std::min<std::uint64_t>(file.size(), 4096);
    return static_cast<std::size_t>(random.below(random.uniform() < 0.5 ? near : file.size()));
  };
  const auto put = [&](std::size_t at, std::uint64_t value, std::size_t bytes) {
    for (std::size_t n = 0; n < bytes && at + n < file.size(); ++n)
      file[at + n] = static_cast<char>((value >> (8 * n)) & 0xFF);
  };
  static constexpr std::uint64_t extremes[] = {0,          1,          0x7F,       0x80,       0xFF,
                                               0xFFFE,     0xFFFF,     0x7FFFFFFF, 0x80000000, 0xFFFFFFFE,
                                               0xFFFFFFFF, 0xE000FFFE, 0x00107FE0, 0x5153};
  const std::uint64_t changes = 1 + random.below(4);
  for (std::uint64_t c = 0; c < changes; ++c) {
    switch (random.below(7)) {
      case 0: file[place()] = static_cast<char>(random.below(256)); break;
      case 1: {
        const std::size_t at = place();
        file[at] = static_cast<char>(file[at] ^ static_cast<char>(1U << random.below(8)));
        break;
      }
      case 2: put(place(), extremes[random.below(std::size(extremes))], random.below(2) == 0 ? 2 : 4); break;
      case 3: {
        const std::size_t at = place();
        file.erase(at, 1 + static_cast<std::size_t>(random.below(64)));
        break;
      }
      case 4: {
        const std::string piece = file.substr(place(), 1 + static_cast<std::size_t>(random.below(200)));
        file.insert(place(), piece);
        break;
      }
      case 5: {
        const std::string piece = file.substr(place(), 1 + static_cast<std::size_t>(random.below(64)));
        file.replace(place(), piece.size(), piece);
        break;
      }
      default:
        if (random.below(4) == 0) file.resize(16 + static_cast<std::size_t>(random.below(file.size() - 15)));
    }
    if (file.size() < 16) return file;
  }
  return file;
}

}  // namespace glisson::test
