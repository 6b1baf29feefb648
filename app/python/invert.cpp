// SPDX-License-Identifier: GPL-3.0-or-later

// Raw phase images to the complex shear modulus.
#include "pipeline/invert.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "bindings.h"
#include "convert.h"
#include "text.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using Path = std::filesystem::path;
using pipeline::InvertedPhases;

std::shared_ptr<InvertedPhases> invert(const std::vector<Path>& phases, double frequency_Hz, int directions,
                                       const std::vector<Eigen::Vector3d>& encodings,
                                       std::optional<double> radiansPerUnit, const std::optional<Path>& mask,
                                       inversion::BulkFilter filter, inversion::Unwrapping unwrapping, int dimensions,
                                       double window_mm, double averaging_mm, double cutoff_mm, double density,
                                       double confidence, const py::object& progress,
                                       const std::shared_ptr<Cancel>& cancel) {
  requireWithin("frequency_Hz", frequency_Hz, 0.0, 1e6);
  requireWithin("directions", directions, 1.0, 12.0);
  requireWithin("confidence", confidence, 0.0, 1.0);
  requirePositive("density_kg_m3", density);
  pipeline::InvertRequest request;
  request.phases.paths = phases;
  request.phases.directions = directions;
  request.phases.encodings_lps = encodings;
  request.phases.radiansPerUnit = radiansPerUnit;
  request.mask = mask.value_or(Path());
  request.unwrapping = unwrapping;
  request.confidence = confidence;
  inversion::InversionOptions& o = request.options;
  o.frequency_Hz = frequency_Hz;
  o.filter = filter;
  o.dimensions = dimensions;
  o.window_mm = window_mm;
  o.averaging_mm = averaging_mm;
  o.cutoff_mm = cutoff_mm;
  o.density_kg_m3 = density;
  return awaited({progress, cancel}, [&](const Progress& p) {
    return std::make_shared<InvertedPhases>(pipeline::invertPhases(request, p));
  });
}

void bindWords(py::module_& m) {
  using inversion::BulkFilter;
  using inversion::Unwrapping;
  py::enum_<BulkFilter>(m, "BulkFilter", "What takes compression away before the inversion.")
      .value("AUTO", BulkFilter::Auto)
      .value("NONE", BulkFilter::None)
      .value("HIGH_PASS", BulkFilter::HighPass)
      .value("CURL", BulkFilter::Curl);
  py::enum_<Unwrapping>(m, "Unwrapping", "How phases are unwrapped.")
      .value("AUTO", Unwrapping::Auto)
      .value("TEMPORAL", Unwrapping::Temporal)
      .value("QUALITY", Unwrapping::Quality);
}

/// A volume of the inversion that lives as long as the whole; None where it has no voxels.
template <image::ScalarVolume inversion::Inversion::*volume>
const image::ScalarVolume* volumeOf(const InvertedPhases& r) {
  const image::ScalarVolume& v = r.inversion.*volume;
  return v.values.empty() ? nullptr : &v;
}

void bindInverted(py::module_& m) {
  using inversion::Inversion;
  const auto inside = py::return_value_policy::reference_internal;
  py::class_<InvertedPhases, std::shared_ptr<InvertedPhases>>(
      m, "Inverted", "What invert() gives. Volumes are kPa and not-a-number where there is no modulus.")
      .def_property_readonly("magnitude_kPa", &volumeOf<&Inversion::magnitude_kPa>, inside,
                             "Volume: |G*|, the complex shear modulus.")
      .def_property_readonly("storage_kPa", &volumeOf<&Inversion::storage_kPa>, inside, "Volume: Re G*.")
      .def_property_readonly("loss_kPa", &volumeOf<&Inversion::loss_kPa>, inside, "Volume: Im G*.")
      .def_property_readonly("shear_kPa", &volumeOf<&Inversion::shear_kPa>, inside,
                             "Volume: density times wave speed squared.")
      .def_property_readonly("confidence", &volumeOf<&Inversion::confidence>, inside, "Volume: 0 to 1.")
      .def_property_readonly("spread_kPa", &volumeOf<&Inversion::spread_kPa>, inside,
                             "Volume: standard deviation of |G*|.")
      .def_property_readonly(
          "mask", [](const InvertedPhases& r) -> const image::Mask& { return r.inversion.mask; }, inside,
          "Mask: voxels with signal, as used.")
      .def_property_readonly(
          "waves",
          [](py::object self) {
            py::list all;
            for (const auto& w : self.cast<const InvertedPhases&>().inversion.waves)
              all.append(py::cast(w, py::return_value_policy::reference_internal, self));
            return all;
          },
          "ComplexVolume of every direction, filtered, as inverted; rad.")
      .def_property_readonly(
          "frequency_Hz", [](const InvertedPhases& r) { return r.inversion.used.frequency_Hz; },
          "Of the vibration, Hz.")
      .def_property_readonly(
          "resolved", [](const InvertedPhases& r) { return r.inversion.resolved; }, "Voxels that have a modulus.")
      .def_readonly("phase_scale", &InvertedPhases::scale, "How values became radians, in words.")
      .def_property_readonly(
          "noise_rad",
          [](const InvertedPhases& r) {
            std::vector<double> noise;
            for (const pipeline::WaveQuality& d : r.directions) noise.push_back(d.noise_rad);
            return noise;
          },
          "Standard deviation of the phase noise, one for each direction, rad.")
      .def_readonly("stiffness", &InvertedPhases::stiffness, "Statistics of |G*| over the confident voxels.")
      .def_readonly("storage", &InvertedPhases::storage, "The same of Re G*.")
      .def_readonly("loss", &InvertedPhases::loss, "The same of Im G*.")
      .def_readonly("shear_stiffness", &InvertedPhases::shear, "The same of density times wave speed squared.")
      .def_readonly("warnings", &InvertedPhases::warnings, "What is doubtful: sentences.")
      .def_property_readonly(
          "diagnostics", [](const InvertedPhases& r) { return listOf(r.diagnostics); }, "Diagnostics.")
      .def(
          "write",
          [](const InvertedPhases& r, const Path& folder) { return pipeline::writeInversion(folder, r.inversion); },
          py::arg("folder"),
          "Writes the volumes as NIfTI, as `glisson-cli invert --output` does; returns the files. Raises BadInput.");
}

}  // namespace

void bindInvert(py::module_& m) {
  bindWords(m);
  bindInverted(m);
  const inversion::InversionOptions d;
  m.def("invert", &invert, py::arg("phases"), py::kw_only(), py::arg("frequency_Hz") = 0.0, py::arg("directions") = 1,
        py::arg("encodings_lps") = std::vector<Eigen::Vector3d>(), py::arg("radians_per_unit") = py::none(),
        py::arg("mask") = py::none(), py::arg("filter") = d.filter, py::arg("unwrapping") = inversion::Unwrapping::Auto,
        py::arg("dimensions") = d.dimensions, py::arg("window_mm") = d.window_mm,
        py::arg("averaging_mm") = d.averaging_mm, py::arg("cutoff_mm") = d.cutoff_mm,
        py::arg("density_kg_m3") = d.density_kg_m3, py::arg("confidence") = defaults::confidenceThreshold,
        py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "Raw phase images of an elastography acquisition to the complex shear modulus; the numbers of `glisson-cli "
        "invert`.\n\n"
        "phases: volumes in order of direction and time, or folders (also DICOM). frequency_Hz: of the vibration; 0: "
        "as the files "
        "say. directions: motion-encoding directions in plain volumes. encodings_lps: their vectors, for the curl. "
        "radians_per_unit: of stored values, where they do not tell. mask: voxels with signal. dimensions: 2 slice by "
        "slice, 3 in "
        "space, 0 by slice distance. window_mm, averaging_mm (radii), cutoff_mm (wavelength): 0 is from the frequency. "
        "confidence: "
        "least one of voxels in the statistics, 0 to 1.\n\nRaises BadInput, Cancelled.");
}

}  // namespace glisson::python
