// SPDX-License-Identifier: GPL-3.0-or-later

// Scenes, and the plan of one.
#include "scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "base/error.h"
#include "bindings.h"
#include "convert.h"
#include "pipeline/plan.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using pipeline::Scene;

std::shared_ptr<Scene> makeScene(const py::object& what, const std::filesystem::path& folder) {
  const std::string text = py::isinstance<py::str>(what)
                               ? what.cast<std::string>()
                               : py::module_::import("json").attr("dumps")(what).cast<std::string>();
  return std::make_shared<Scene>(pipeline::parseScene(text, folder));
}

void bindPlan(py::module_& m) {
  using pipeline::PlanStep;
  py::class_<PlanStep>(m, "PlanStep", "One step that a scene needs, or leaves out, and why.")
      .def_readonly("step", &PlanStep::step, "E.g. \"measure-stiffness\".")
      .def_readonly("needed", &PlanStep::needed, "Whether it is done.")
      .def_readonly("why", &PlanStep::why, "A sentence.")
      .def_readonly("seconds", &PlanStep::seconds, "Predicted; in Run.plan measured, s.")
      .def_readonly("peak_MB", &PlanStep::peak_MB, "Memory, predicted; in Run.plan measured, MB.")
      .def("__repr__",
           [](const PlanStep& s) { return "<glisson.PlanStep " + s.step + (s.needed ? " needed>" : " left out>"); });
  m.def(
      "plan", [](const SceneOrPath& scene) { return pipeline::plan(sceneOf(scene)); }, py::arg("scene"),
      "Every step, in order, needed or left out with its reason, and what it will take. scene: Scene, or path of a "
      "scene.json, "
      "case.json or case folder. Raises BadInput.");
  m.def(
      "doubts", [](const SceneOrPath& scene) { return listOf(pipeline::toldOf(sceneOf(scene))); }, py::arg("scene"),
      "What makes one doubt a scene before anything is solved, and which of its settings go unused: Diagnostics.");
}

}  // namespace

Scene sceneOf(const SceneOrPath& given) {
  if (const auto* path = std::get_if<std::filesystem::path>(&given)) return pipeline::readScene(*path);
  const auto& scene = std::get<std::shared_ptr<Scene>>(given);
  if (!scene) throw BadArgument("a scene is needed; None was given");
  return *scene;
}

void bindScene(py::module_& m) {
  py::class_<Scene, std::shared_ptr<Scene>>(
      m, "Scene", "One declarative scene (glisson/scene/1): geometry, material, supports, loads, outputs.")
      .def(py::init(&makeScene), py::arg("scene"), py::arg("folder") = std::filesystem::path("."),
           "scene: the dict that a scene.json would hold, or its text. folder: relative paths in it are seen from "
           "there. Raises "
           "BadInput that names the key for what is unknown, missing, or of a wrong type or unit.")
      .def(
          "to_dict", [](const Scene& s) { return fromJson(pipeline::toJson(s)); },
          "The scene with every default written out, paths relative to folder; Scene(d, scene.folder) of it is the "
          "same scene, "
          "so that a study changes some values and makes the next one.")
      .def_readonly("folder", &Scene::folder, "Relative paths of the file are seen from there.");
  m.def(
      "read_scene",
      [](const std::filesystem::path& file) { return std::make_shared<Scene>(pipeline::readScene(file)); },
      py::arg("file"),
      "Reads a scene.json, or the scene of a case (case.json or its folder). Raises BadInput with key and line.");
  bindPlan(m);
}

}  // namespace glisson::python
