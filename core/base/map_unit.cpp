// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/map_unit.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "base/text.h"

namespace glisson {
namespace {

struct Name {
  const char* text;
  bool exact;  ///< capitals tell milli from mega
  MapUnit unit;
};

constexpr MapUnit modulus(double kPa) {
  return {MapUnit::Of::Modulus, kPa};
}

constexpr MapUnit speed(double m_s) {
  return {MapUnit::Of::Speed, m_s};
}

constexpr Name names[] = {
    {"mPa", true, modulus(1e-6)},         {"MPa", true, modulus(1e3)},         {"kpa", false, modulus(1.0)},
    {"pa", false, modulus(1e-3)},         {"hpa", false, modulus(0.1)},        {"gpa", false, modulus(1e6)},
    {"pascal", false, modulus(1e-3)},     {"pascals", false, modulus(1e-3)},   {"kilopascal", false, modulus(1.0)},
    {"kilopascals", false, modulus(1.0)}, {"megapascal", false, modulus(1e3)}, {"n/m2", false, modulus(1e-3)},
    {"n/m^2", false, modulus(1e-3)},      {"n/m²", false, modulus(1e-3)},      {"n.m-2", false, modulus(1e-3)},
    {"kn/m2", false, modulus(1.0)},       {"kn/m^2", false, modulus(1.0)},     {"kn/m²", false, modulus(1.0)},
    {"dyn/cm2", false, modulus(1e-4)},    {"m/s", false, speed(1.0)},          {"m.s-1", false, speed(1.0)},
    {"dm/s", false, speed(0.1)},          {"cm/s", false, speed(0.01)},        {"mm/s", false, speed(1e-3)},
};

}  // namespace

std::optional<MapUnit> mapUnit(const std::string& text) {
  double factor = 1.0;
  const char* begin = text.data();
  const char* end = begin + text.size();
  while (begin != end && *begin == ' ') ++begin;
  while (begin != end && end[-1] == ' ') --end;
  const auto [stop, error] = std::from_chars(begin, end, factor);
  if (error == std::errc() && stop != begin) {
    if (!std::isfinite(factor) || factor <= 0.0) return std::nullopt;
    begin = stop;
    while (begin != end && *begin == ' ') ++begin;
  } else {
    factor = 1.0;
  }
  const std::string unit(begin, end), small = lowerCase(unit);
  for (const Name& n : names)
    if (n.exact ? unit == n.text : small == n.text) return MapUnit{n.unit.of, factor * n.unit.factor};
  return std::nullopt;
}

std::string canonicalUnit(const std::string& text) {
  const auto unit = mapUnit(text);
  if (!unit) return text;
  const char* name = unit->of == MapUnit::Of::Speed ? "m/s" : "kPa";
  if (unit->factor == 1.0) return name;
  if (unit->of == MapUnit::Of::Modulus && std::abs(unit->factor - 1e-3) < 1e-12) return "Pa";
  std::ostringstream out;
  out.precision(9);
  out << unit->factor << name;
  return out.str();
}

}  // namespace glisson
