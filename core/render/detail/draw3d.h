// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/overlay.h"

namespace glisson::render {

/// File name of the part of the program that draws in 3-D, beside the other libraries of the program.
inline constexpr const char* draw3dFile = "glisson_render3d.so";
/// Name of its one entry, of type Draw3d.
inline constexpr const char* draw3dEntry = "glissonDraw3d";

/// 3-D pictures of one scene to be drawn. Program and part are built together and hand each other C++ types, so `build`
/// (version and commit) is compared first.
struct Draw3dJob {
  const RetractionScene* scene = nullptr;
  const std::vector<SceneOptions3D>* options = nullptr;
  RenderBackend backend = RenderBackend::Auto;
  int threads = 0;
  /// Takes each picture in turn; false ends the job. Throws nothing.
  std::function<bool(std::size_t, Picture&&)> take;
  std::string error;  ///< out: what went wrong, in words
};

enum class Draw3dOutcome : int { Drawn = 0, Unavailable, BadInputFound, BadArgumentFound, Failed, OtherBuild };

/// No exception leaves it: they do not cross from one library to another by contract.
using Draw3d = Draw3dOutcome(const char* build, Draw3dJob& job) noexcept;

}  // namespace glisson::render
