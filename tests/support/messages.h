// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/error.h"

namespace glisson::test {

/// What a BadInput thrown by f says; "no BadInput" where there is none.
template <typename F>
std::string messageOf(F&& f) {
  try {
    f();
  } catch (const BadInput& e) {
    return e.what();
  }
  return "no BadInput";
}

}  // namespace glisson::test
