// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace glisson {

/// Sets that are joined two by two (union-find), each named after its smallest member: the same whatever the order of
/// the joins. Members are 0 ... count − 1.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0); }

  /// Name of the set that holds i.
  int find(int i) {
    while (at(i) != i) i = at(i) = at(at(i));
    return i;
  }

  /// False where both are in one set already.
  bool join(int a, int b) {
    a = find(a);
    b = find(b);
    at(std::max(a, b)) = std::min(a, b);
    return a != b;
  }

 private:
  int& at(int i) { return root_[static_cast<std::size_t>(i)]; }
  std::vector<int> root_;
};

}  // namespace glisson
