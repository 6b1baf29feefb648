// SPDX-License-Identifier: GPL-3.0-or-later

// What one simulated retraction gives, and the difference of two.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "comparison/difference.h"
#include "convert.h"
#include "retraction/simulate.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using retraction::Result;
using retraction::RigidContact;

std::string nameOf(retraction::Kinematics kinematics) {
  switch (kinematics) {
    case retraction::Kinematics::Linear: return "linear";
    case retraction::Kinematics::Corotational: return "corotational";
    case retraction::Kinematics::Hyperelastic: return "hyperelastic";
    case retraction::Kinematics::Auto: return "auto";
  }
  return "";
}

void bindModel(py::module_& m) {
  using retraction::Model;
  py::class_<Model>(m, "Model", "The body of a scene: equal cells on a grid.")
      .def_readonly("youngs_kPa", &Model::youngs_kPa, "Volume: Young's modulus of every cell, kPa; 0 outside the body.")
      .def_readonly("poisson", &Model::poisson, "Poisson's ratio.")
      .def_property_readonly(
          "density_kg_m3", [](const Model& model) { return model.density.kgPerM3(); }, "kg/m^3.")
      .def_readonly("cells", &Model::cells, "Cells of the body.")
      .def_readonly("volume_mL", &Model::volume_mL, "mL.")
      .def_readonly("mass_kg", &Model::mass_kg, "kg.");
}

void bindContact(py::module_& m) {
  py::class_<RigidContact>(m, "Contact", "What a rigid bar and the liver do to each other at the end; LPS.")
      .def_property_readonly("answered", &RigidContact::answered, "The force or the travel asked for was reached.")
      .def_property_readonly("slipped", &RigidContact::slipped, "The liver does not bear the force asked for.")
      .def_readonly("travel_mm", &RigidContact::travel_mm, "Way of the bar from its first force, along the hoist, mm.")
      .def_readonly("capacity_N", &RigidContact::capacity_N, "Largest force met on the way, N.")
      .def_readonly("force_N", &RigidContact::force_N, "Of the bar on the liver, N.")
      .def_readonly("moment_Nm", &RigidContact::moment_Nm, "About the bar's centre, N m.")
      .def_readonly("hoist", &RigidContact::hoist, "Unit vector of the hoist.")
      .def_readonly("area_mm2", &RigidContact::area_mm2, "Of the surface that touches, mm^2.")
      .def_readonly("footprint_mm2", &RigidContact::footprint_mm2, "The same, seen along the hoist, mm^2.")
      .def_readonly("pressure_max_kPa", &RigidContact::pressureMax_kPa, "Largest pressure, kPa.")
      .def_property_readonly(
          "path",
          [](py::object self) {
            const auto& path = self.cast<const RigidContact&>().path;
            return view(path.empty() ? nullptr : path.front().data(), {static_cast<py::ssize_t>(path.size()), 2},
                        {2 * sizeof(double), sizeof(double)}, self);
          },
          "array[n, 2]: travel (mm) and force (N) on the way; no copy.")
      .def_property_readonly(
          "sample_mm", [](py::object self) { return viewOf(self.cast<const RigidContact&>().sample_mm, self); },
          "array[n, 3]: samples of the smooth surface at rest, LPS mm; no copy.")
      .def_property_readonly(
          "sample_u_mm", [](py::object self) { return viewOf(self.cast<const RigidContact&>().sample_u_mm, self); },
          "array[n, 3]: their displacements, LPS mm; no copy.")
      .def_property_readonly(
          "sample_mm2", [](py::object self) { return viewOf(self.cast<const RigidContact&>().sample_mm2, self); },
          "array[n]: the area of each, mm^2; no copy.")
      .def_property_readonly(
          "pressure_kPa", [](py::object self) { return viewOf(self.cast<const RigidContact&>().pressure_kPa, self); },
          "array[n]: the pressure on each, kPa; no copy.");
}

void bindSolver(py::module_& m) {
  using mechanics::SolveReport;
  py::class_<SolveReport>(m, "Solver", "How a solve ended.")
      .def_readonly("kind", &SolveReport::kind, "E.g. \"multigrid-pcg\".")
      .def_property_readonly("converged", &SolveReport::converged,
                             "Whether the tolerance was reached; without it the result is no answer.")
      .def_readonly("iterations", &SolveReport::iterations, "Number.")
      .def_readonly("residual", &SolveReport::residual, "Relative, |f - K u| / |f|.")
      .def_readonly("tolerance", &SolveReport::tolerance, "Relative, as asked for.");
}

void bindResult(py::module_& m) {
  py::class_<Result>(m, "Retraction", "One simulated retraction, mm and LPS.")
      .def_readonly("displacement_mm", &Result::u_mm, "DisplacementField at the cells' centres.")
      .def_property_readonly(
          "probes_mm", [](py::object self) { return viewOf(self.cast<const Result&>().probe_u_mm, self); },
          "array[n, 3]: displacement of the scene's probes, LPS mm; no copy.")
      .def_readonly("dofs", &Result::dofs, "Degrees of freedom.")
      .def_readonly("solver", &Result::solver, "Solver: how the solve ended.")
      .def_property_readonly(
          "kinematics", [](const Result& r) { return nameOf(r.kinematics); },
          "\"linear\", \"corotational\" or \"hyperelastic\".")
      .def_readonly("load_N", &Result::load_N, "Sum of the applied forces at the end, N.")
      .def_readonly("reaction_N", &Result::reaction_N, "Sum of the forces of the supports, N.")
      .def_readonly("energy_J", &Result::energy_J, "Elastic energy, J.")
      .def_readonly("max_strain", &Result::max_strain, "Largest principal strain, absolute.")
      .def_readonly("p95_strain", &Result::p95_strain, "95 % of the cells are below.")
      .def_readonly("max_rotation_deg", &Result::max_rotation_deg, "Largest rotation of a cell, degrees.")
      .def_readonly("max_displacement_mm", &Result::max_displacement_mm, "Largest displacement, mm.")
      .def_readonly("validity", &Result::validity, "What is said against the answer, most serious first: sentences.")
      .def_property_readonly(
          "doubts", [](const Result& r) { return listOf(r.doubts); }, "The same as Diagnostics.")
      .def_property_readonly(
          "contact", [](const Result& r) { return r.contact ? &*r.contact : nullptr; },
          py::return_value_policy::reference_internal, "Contact of a rigid bar; None without one.");
}

void bindDifference(py::module_& m) {
  using comparison::Difference;
  py::class_<Difference>(m, "Difference", "How far apart two retractions of one liver place the same tissue, mm.")
      .def_readonly("mean_mm", &Difference::mean_mm, "Mean over the cells.")
      .def_readonly("p95_mm", &Difference::p95_mm, "95 % of the cells are below.")
      .def_readonly("max_mm", &Difference::max_mm, "Largest.")
      .def_readonly("at_retractor_mm", &Difference::at_retractor_mm, "Mean over the contact; 0 without a retractor.")
      .def_readonly("travel_mm", &Difference::travel_mm,
                    "Travel of a rigid bar in the one less that in the other; else None.")
      .def_readonly("clinically_significant", &Difference::clinically_significant,
                    "5 mm or more at the retractor (else at most).")
      .def_property_readonly(
          "vessel_mm", [](py::object self) { return viewOf(self.cast<const Difference&>().vessel_mm, self); },
          "array[n]: at every vessel landmark (Run.landmarks_mm); no copy.")
      .def_readonly("vessel_mean_mm", &Difference::vesselMean_mm, "Mean over the landmarks.")
      .def_readonly("vessel_p95_mm", &Difference::vesselP95_mm, "95 % of the landmarks are below.")
      .def_readonly("vessel_max_mm", &Difference::vesselMax_mm, "Largest at a landmark.");
}

}  // namespace

void bindRetraction(py::module_& m) {
  bindModel(m);
  bindContact(m);
  bindSolver(m);
  bindResult(m);
  bindDifference(m);
}

}  // namespace glisson::python
