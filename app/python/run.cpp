// SPDX-License-Identifier: GPL-3.0-or-later

// Everything that a scene needs, in one call.
#include "pipeline/run.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "await.h"
#include "base/error.h"
#include "bindings.h"
#include "convert.h"
#include "scene.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using pipeline::RunResult;

std::shared_ptr<RunResult> run(const SceneOrPath& given, const std::optional<std::filesystem::path>& output,
                               bool howSure, bool overrideChecks, bool colourBlind, std::optional<std::uint64_t> seed,
                               const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  pipeline::Scene scene = sceneOf(given);
  scene.geometry.overrideChecks = scene.geometry.overrideChecks || overrideChecks;
  if (howSure && !scene.uncertainty) scene.uncertainty.emplace();
  if (seed) scene.setup.seed = scene.setup.model.meshfree.seed = *seed;
  pipeline::RunOptions options;
  options.output = output.value_or(std::filesystem::path());
  options.palette = colourBlind ? render::Palette::ColourBlind : render::Palette::RedBlue;
  return awaited({progress, cancel},
                 [&](const Progress& p) { return std::make_shared<RunResult>(pipeline::run(scene, options, p)); });
}

/// Copied into an array of its own: it is made for this call.
py::array displacementAt(const RunResult& r,
                         const py::array_t<double, py::array::c_style | py::array::forcecast>& points, bool atlas) {
  if (atlas && !r.atlas) throw BadArgument("the scene compares with no atlas: it has no second answer");
  auto moved = std::make_unique<std::vector<Eigen::Vector3d>>(
      retraction::displacementAt(r.model, atlas ? *r.atlas : r.primary, pointsOf(points)));
  const std::vector<Eigen::Vector3d>& u = *moved;
  const py::capsule owner(moved.release(), [](void* p) { delete static_cast<std::vector<Eigen::Vector3d>*>(p); });
  return viewOf(u, owner);
}

}  // namespace

void bindRun(py::module_& m) {
  const auto inside = py::return_value_policy::reference_internal;
  py::class_<RunResult, std::shared_ptr<RunResult>>(
      m, "Run", "What one run gives. What the scene does not ask for is None or empty.")
      .def_property_readonly(
          "record", [](const RunResult& r) { return fromJson(r.json); },
          "The run record, as run.json holds it: every number with its unit in its name, parameters, digests. "
          "Parsed at each call.")
      .def_property_readonly(
          "results_sha256", [](const RunResult& r) { return fromJson(r.json)["results_sha256"].cast<std::string>(); },
          "SHA-256 of all numbers; the same as that of `glisson-cli run` to the last bit.")
      .def_readonly("plan", &RunResult::plan, "Every PlanStep, with the seconds that it took.")
      .def_readonly("model", &RunResult::model, "Model: the body.")
      .def_readonly("primary", &RunResult::primary, "Retraction with the scene's own stiffness.")
      .def_property_readonly(
          "atlas", [](const RunResult& r) { return r.atlas ? &*r.atlas : nullptr; }, inside,
          "Retraction with the textbook stiffness, where the scene compares.")
      .def_property_readonly(
          "difference", [](const RunResult& r) { return r.difference ? &*r.difference : nullptr; }, inside,
          "Difference of the two, where both are answers.")
      .def_property_readonly(
          "stiffness", [](const RunResult& r) { return r.stiffness ? &*r.stiffness : nullptr; }, inside,
          "Measurement over the region of interest, where an elastogram is used.")
      .def_property_readonly(
          "landmarks_mm", [](py::object self) { return viewOf(self.cast<const RunResult&>().landmarks_mm, self); },
          "array[n, 3]: centre lines of the vessels at rest, LPS mm; no copy.")
      .def("displacement_at", &displacementAt, py::arg("points_mm"), py::arg("atlas") = false,
           "array[n, 3]: how points (LPS mm, array[n, 3]) move, mm; not-a-number outside the body. Raises BadArgument.")
      .def_property_readonly(
          "converged",
          [](const RunResult& r) { return r.primary.solver.converged() && (!r.atlas || r.atlas->solver.converged()); },
          "Whether the numbers are an answer; else diagnostics say why not (the command line's exit code 4).")
      .def_readonly("files", &RunResult::files, "Everything written, run.json first.")
      .def_readonly("warnings", &RunResult::warnings, "What is doubtful: sentences.")
      .def_property_readonly(
          "diagnostics", [](const RunResult& r) { return listOf(r.diagnostics); }, "Diagnostics.");
  m.def("run", &run, py::arg("scene"), py::arg("output") = py::none(), py::kw_only(), py::arg("uncertainty") = false,
        py::arg("override") = false, py::arg("colour_blind") = false, py::arg("seed") = py::none(),
        py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "Does everything that plan() says; the numbers of `glisson-cli run`.\n\n"
        "scene: Scene, or path of a scene.json, case.json or case folder. output: folder for results and pictures; "
        "None writes "
        "nothing. uncertainty: say how sure the answer is (record[\"uncertainty\"]). override: MRI and elastogram of "
        "other days or "
        "patients are meant. colour_blind: orange and blue instead of red and blue. seed: of everything random.\n\n"
        "A solve that does not converge raises nothing: see Run.converged. Raises BadInput, SolverFailed, Cancelled.");
}

}  // namespace glisson::python
