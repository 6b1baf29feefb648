// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "render/overlay.h"

namespace glisson::render {

/// File name of the part of the program that draws in 3-D, beside the other libraries of the program.
inline constexpr const char* draw3dFile = "glisson_render3d.so";
/// Name of its one entry, of type Draw3d.
inline constexpr const char* draw3dEntry = "glissonDraw3d";

/// One 3-D picture to be drawn. Program and part are built together and hand each other C++ types, so `build` (version
/// and commit) is compared first.
struct Draw3dJob {
  const RetractionScene* scene = nullptr;
  const SceneOptions3D* options = nullptr;
  RenderBackend backend = RenderBackend::Auto;
  int threads = 0;
  Picture picture;    ///< out
  std::string error;  ///< out: what went wrong, in words
};

enum class Draw3dOutcome : int { Drawn = 0, Unavailable, BadInputFound, BadArgumentFound, Failed, OtherBuild };

/// No exception leaves it: they do not cross from one library to another by contract.
using Draw3d = Draw3dOutcome(const char* build, Draw3dJob& job) noexcept;

}  // namespace glisson::render
