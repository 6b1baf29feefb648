// SPDX-License-Identifier: GPL-3.0-or-later
#include "text.h"

#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::python {
namespace {

[[noreturn]] void refuse(const char* argument, double value, const std::string& range) {
  std::ostringstream text;
  text << argument << " is " << value << "; give " << range;
  throw BadInput(text.str());
}

}  // namespace

StiffnessQuantity quantityNamed(const std::string& word) {
  if (word == "shear") return StiffnessQuantity::Shear;
  if (word == "youngs") return StiffnessQuantity::Youngs;
  throw BadInput("quantity is \"" + word.substr(0, 40) + "\"; give \"shear\" or \"youngs\"");
}

std::string nameOf(StiffnessQuantity quantity) {
  return quantity == StiffnessQuantity::Shear ? "shear" : "youngs";
}

void requireWithin(const char* argument, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream range;
  range << "a number from " << low << " to " << high;
  refuse(argument, value, range.str());
}

void requirePositive(const char* argument, double value) {
  if (!std::isfinite(value) || value <= 0.0) refuse(argument, value, "a number above 0");
}

}  // namespace glisson::python
