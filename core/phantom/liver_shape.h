// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace glisson::phantom {

/// How a synthetic liver is built. Short: ends well above the usual lower margin. Wide: flat, from flank to flank.
/// ThinLobe: a right lobe that is thin from front to back. Riedel: a tongue hangs from the right lobe. LargeLeft: a
/// large left lobe beside a small right one.
enum class LiverShape { Usual, Short, Wide, ThinLobe, Riedel, LargeLeft };

/// Every shape with its name on the command line and in truth.json.
inline constexpr std::array<std::pair<LiverShape, std::string_view>, 6> liverShapes = {
    {{LiverShape::Usual, "usual"},
     {LiverShape::Short, "short"},
     {LiverShape::Wide, "wide"},
     {LiverShape::ThinLobe, "thin-lobe"},
     {LiverShape::Riedel, "riedel"},
     {LiverShape::LargeLeft, "large-left"}}};

/// As the command line names it.
inline std::string nameOf(LiverShape shape) {
  for (const auto& [s, name] : liverShapes)
    if (s == shape) return std::string(name);
  return "usual";
}

/// Empty for a name that is none of them.
inline std::optional<LiverShape> liverShapeNamed(std::string_view name) {
  for (const auto& [s, n] : liverShapes)
    if (n == name) return s;
  return std::nullopt;
}

}  // namespace glisson::phantom
