// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <variant>

#include "pipeline/scene.h"

namespace glisson::python {

/// A scene as functions take it: made by Scene or read_scene, or the path of a file.
using SceneOrPath = std::variant<std::shared_ptr<pipeline::Scene>, std::filesystem::path>;

/// A copy of the scene, or what the file holds. Throws BadInput as pipeline::readScene does.
pipeline::Scene sceneOf(const SceneOrPath& given);

}  // namespace glisson::python
