// SPDX-License-Identifier: GPL-3.0-or-later

// A liver that follows the tool, frame by frame.
#include "retraction/live.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>

#include "arrays.h"
#include "await.h"
#include "base/error.h"
#include "bindings.h"
#include "pipeline/models.h"
#include "retraction/live_condensed.h"
#include "scene.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using retraction::CondensedRetraction;
using retraction::LiveAnswer;
using retraction::LiveRetraction;

/// Both livers, and what is watched in them.
struct Live {
  std::vector<Eigen::Vector3d> points_mm;
  retraction::LiveLivers livers;
  std::mutex busy;  ///< a liver takes one frame at a time
};

/// One of the two.
struct LiveLiver {
  std::shared_ptr<Live> of;
  LiveRetraction* it;
};

retraction::LiveKind kindNamed(const std::string& word, const retraction::Setup& setup) {
  if (word == "auto") return retraction::liveKindOf(setup);
  if (word == "contact") return retraction::LiveKind::Contact;
  if (word == "condensed") return retraction::LiveKind::Condensed;
  throw BadInput("model is \"" + word.substr(0, 40) + "\"; give \"auto\", \"contact\" or \"condensed\"");
}

std::shared_ptr<Live> makeLive(
    const SceneOrPath& given, const std::string& model,
    const std::optional<py::array_t<double, py::array::c_style | py::array::forcecast>>& points,
    const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  const pipeline::Scene scene = sceneOf(given);
  const retraction::LiveKind kind = kindNamed(model, scene.setup);
  auto live = std::make_shared<Live>();
  if (points) live->points_mm = pointsOf(*points);
  await({progress, cancel}, [&](const Progress& p) {
    const bool own = !live->points_mm.empty();
    const pipeline::Models models = pipeline::buildModels(scene, !own, p.part(0.0, 0.6));
    if (!own) live->points_mm = pipeline::followedPoints(scene, models);
    live->livers = retraction::makeLive(models.model, models.atlas ? &*models.atlas : nullptr, scene.setup,
                                        live->points_mm, kind, p.part(0.6, 1.0));
  });
  return live;
}

/// Points of a 3 x n matrix as array[n, 3] that owns it.
py::array pointsOwned(Eigen::Matrix3Xd&& u_mm) {
  auto moved = std::make_unique<Eigen::Matrix3Xd>(std::move(u_mm));
  const double* data = moved->data();
  const py::ssize_t n = moved->cols();
  const py::capsule owner(moved.release(), [](void* p) { delete static_cast<Eigen::Matrix3Xd*>(p); });
  return view(data, {n, 3}, {3 * sizeof(double), sizeof(double)}, owner);
}

LiveAnswer follow(const LiveLiver& liver, const std::optional<Eigen::Vector3d>& force_N,
                  const std::optional<Eigen::Vector3d>& tool_mm) {
  if (force_N && tool_mm) throw BadArgument("follow takes a force or a place of the tool, not both");
  retraction::LiveTarget target = liver.it->sceneTarget();
  if (force_N) target = {Eigen::Vector3d::Zero(), *force_N};
  if (tool_mm) target = {*tool_mm, {}};
  const py::gil_scoped_release others;
  const std::lock_guard lock(liver.of->busy);
  return liver.it->follow(target);
}

py::array displacements(const LiveLiver& liver) {
  Eigen::Matrix3Xd u_mm;
  {
    const py::gil_scoped_release others;
    const std::lock_guard lock(liver.of->busy);
    liver.it->displacements(u_mm);
  }
  return pointsOwned(std::move(u_mm));
}

const CondensedRetraction& condensedOf(const LiveLiver& liver) {
  const auto* condensed = dynamic_cast<const CondensedRetraction*>(liver.it);
  if (condensed == nullptr) throw BadArgument("only a condensed liver answers this: make it with model=\"condensed\"");
  return *condensed;
}

py::array evaluate(const LiveLiver& liver, const Eigen::Vector3d& force_N) {
  Eigen::Matrix3Xd u_mm;
  condensedOf(liver).evaluate(force_N, u_mm);
  return pointsOwned(std::move(u_mm));
}

std::string nameOf(retraction::LiveOutcome outcome) {
  switch (outcome) {
    case retraction::LiveOutcome::Borne: return "borne";
    case retraction::LiveOutcome::Slips: return "slips";
    case retraction::LiveOutcome::Cuts: return "cuts";
  }
  return "";
}

void bindAnswer(py::module_& m) {
  py::class_<LiveAnswer>(m, "LiveAnswer", "Where the tool is after a frame, and how far the liver is from rest; LPS.")
      .def_readonly("tool_mm", &LiveAnswer::tool_mm, "Place of the tool, from rest, mm.")
      .def_readonly("force_N", &LiveAnswer::force_N, "Of the tool on the liver, N.")
      .def_readonly("remaining_mm", &LiveAnswer::remaining_mm, "Estimated largest distance from equilibrium, mm.")
      .def_readonly("at_rest", &LiveAnswer::atRest, "What was asked for is reached: further frames change nothing.")
      .def_property_readonly(
          "outcome", [](const LiveAnswer& a) { return nameOf(a.outcome); }, "\"borne\", \"slips\" or \"cuts\".");
}

void bindLiver(py::module_& m) {
  py::class_<LiveLiver>(m, "LiveLiver",
                        "A liver that follows the tool. Calls from several threads wait for each other.")
      .def_property_readonly(
          "tool_point_mm", [](const LiveLiver& l) { return l.it->toolPoint_mm(); }, "Contact at rest, LPS mm.")
      .def_property_readonly(
          "scene_force_N", [](const LiveLiver& l) { return l.it->sceneForce_N(); },
          "The scene's own force of the tool, N.")
      .def_property_readonly(
          "dofs", [](const LiveLiver& l) { return l.it->dofs(); }, "Degrees of freedom.")
      .def_property_readonly(
          "cell_mm", [](const LiveLiver& l) { return l.it->cell_mm(); }, "Longest edge of a cell, mm.")
      .def("follow", &follow, py::kw_only(), py::arg("force_N") = py::none(), py::arg("tool_mm") = py::none(),
           "One frame towards a force of the tool (N) or its place from rest (mm), LPS; without either towards what "
           "the scene asks "
           "of it. Raises BadArgument, SolverFailed.")
      .def("displacements", &displacements,
           "array[n, 3]: how the watched points have moved, LPS mm; made for this call.")
      .def("evaluate", &evaluate, py::arg("force_N"),
           "array[n, 3]: displacements under a force of the tool (N), LPS mm, without a frame. Condensed only, else "
           "BadArgument.")
      .def(
          "force_for",
          [](const LiveLiver& l, const Eigen::Vector3d& tool_mm) { return condensedOf(l).forceFor(tool_mm); },
          py::arg("tool_mm"), "Force (N) that moves the contact by tool_mm (mm). Condensed only, else BadArgument.")
      .def(
          "tool_displacement_mm",
          [](const LiveLiver& l, const Eigen::Vector3d& force_N) {
            return condensedOf(l).toolDisplacement_mm(force_N);
          },
          py::arg("force_N"),
          "How the contact moves (mm) under a force of the tool (N). Condensed only, else BadArgument.");
}

}  // namespace

void bindLive(py::module_& m) {
  bindAnswer(m);
  bindLiver(m);
  py::class_<Live, std::shared_ptr<Live>>(m, "Live", "Both livers of a scene, ready to follow the tool.")
      .def_property_readonly(
          "points_mm", [](py::object self) { return viewOf(self.cast<const Live&>().points_mm, self); },
          "array[n, 3]: the watched points at rest, LPS mm; no copy.")
      .def_property_readonly(
          "kind",
          [](const Live& l) {
            return std::string(l.livers.kind == retraction::LiveKind::Contact ? "contact" : "condensed");
          },
          "\"contact\" or \"condensed\".")
      .def_property_readonly(
          "measured",
          [](const std::shared_ptr<Live>& l) {
            return LiveLiver{l, l->livers.mre.get()};
          },
          "LiveLiver with the scene's own stiffness.")
      .def_property_readonly(
          "atlas",
          [](const std::shared_ptr<Live>& l) -> std::optional<LiveLiver> {
            if (!l->livers.atlas) return {};
            return LiveLiver{l, l->livers.atlas.get()};
          },
          "LiveLiver with the textbook stiffness; None where the scene does not compare.");
  m.def("live", &makeLive, py::arg("scene"), py::kw_only(), py::arg("model") = "auto",
        py::arg("points_mm") = py::none(), py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "Makes the livers of a scene ready to follow its retractor; those of `glisson-cli live`.\n\n"
        "model: \"condensed\" is a linear patch of pressure condensed to the watched points (microseconds an answer), "
        "\"contact\" a "
        "rigid bar in large deformation (milliseconds), \"auto\" as the scene's retractor. points_mm: array[n, 3] in "
        "LPS mm to watch; "
        "None: the vessels, or the scene's probes without any.\n\nRaises BadInput, SolverFailed, Cancelled.");
}

}  // namespace glisson::python
