// SPDX-License-Identifier: GPL-3.0-or-later

// Stiffness statistics of a region of interest.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "base/error.h"
#include "bindings.h"
#include "convert.h"
#include "pipeline/measure.h"
#include "text.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using Path = std::filesystem::path;
using pipeline::MeasuredRegion;

std::shared_ptr<MeasuredRegion> measure(const Path& mre, const Path& roi, const std::optional<Path>& mri,
                                        const std::optional<std::string>& quantity,
                                        const std::optional<std::string>& unit,
                                        const std::map<std::string, std::string>& roles, bool overrideChecks,
                                        std::optional<int> label, const std::string& name,
                                        std::optional<double> confidence, std::optional<double> confidenceScale,
                                        int erodePixels, double erode_mm, const std::optional<Path>& exclude,
                                        bool registration, const std::optional<Path>& magnitude, double poisson,
                                        const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  requireWithin("confidence", confidence.value_or(0.0), 0.0, 1.0);
  requireWithin("poisson", poisson, 0.0, 0.5);
  requireWithin("erode_px", erodePixels, 0.0, 100.0);
  requireWithin("erode_mm", erode_mm, 0.0, 100.0);
  pipeline::MeasureRequest request;
  request.mre = mre;
  request.roi = roi;
  request.mri = mri.value_or(Path());
  if (quantity) request.quantity = quantityNamed(*quantity);
  request.unit = unit;
  request.roles = rolesOf(roles);
  request.overrideChecks = overrideChecks;
  request.label = label;
  request.name = name;
  request.confidence = confidence;
  request.confidenceScale = confidenceScale;
  request.erosion_pixels = erodePixels;
  request.erosion_mm = erode_mm;
  request.exclude = exclude.value_or(Path());
  request.registration = registration;
  request.magnitude = magnitude.value_or(Path());
  request.poisson = poisson;
  return awaited({progress, cancel}, [&](const Progress& p) {
    return std::make_shared<MeasuredRegion>(pipeline::measureRegion(request, p));
  });
}

void bindStatistics(py::module_& m) {
  using elastography::Statistics;
  py::class_<Statistics>(m, "Statistics",
                         "Of the voxels that count: finite, above zero, confident. Not-a-number where none does.")
      .def_readonly("n", &Statistics::n, "Voxels that count.")
      .def_readonly("n_before_mask", &Statistics::n_before_mask, "Voxels of the (eroded) region.")
      .def_readonly("area_mm2", &Statistics::area_mm2, "n times the area of a voxel in its plane, mm^2.")
      .def_readonly("mean_kPa", &Statistics::mean_kPa, "Mean, kPa.")
      .def_readonly("median_kPa", &Statistics::median_kPa, "Median, kPa.")
      .def_readonly("sd_kPa", &Statistics::sd_kPa, "Sample standard deviation, kPa.")
      .def_readonly("min_kPa", &Statistics::min_kPa, "Least value, kPa.")
      .def_readonly("max_kPa", &Statistics::max_kPa, "Largest value, kPa.");
  using elastography::SliceStatistics;
  py::class_<SliceStatistics>(m, "SliceStatistics", "Statistics of one slice.")
      .def_readonly("slice", &SliceStatistics::slice, "Index k of the elastogram.")
      .def_readonly("statistics", &SliceStatistics::statistics, "Statistics.");
  using elastography::Measurement;
  py::class_<Measurement, std::shared_ptr<Measurement>>(
      m, "Measurement", "Stiffness of a region. What *_kPa holds is the modulus that quantity names.")
      .def_property_readonly(
          "quantity", [](const Measurement& r) { return nameOf(r.quantity); },
          "\"shear\" (mu) or \"youngs\" (E): of every *_kPa but youngs_mean_kPa and shear_mean_kPa.")
      .def_readonly("pooled", &Measurement::pooled, "Statistics over all slices.")
      .def_readonly("slices", &Measurement::slices, "SliceStatistics of every slice with voxels of the region.")
      .def_readonly("area_weighted_mean_kPa", &Measurement::areaWeightedMean_kPa,
                    "Mean of the slices' means by their areas, kPa.")
      .def_readonly("youngs_mean_kPa", &Measurement::youngs_mean_kPa, "The pooled mean as E = 2 (1 + nu) mu, kPa.")
      .def_readonly("shear_mean_kPa", &Measurement::shear_mean_kPa, "The pooled mean as mu, kPa.")
      .def_readonly("poisson", &Measurement::poisson, "Poisson's ratio of that conversion.")
      .def_property_readonly(
          "mean_se_kPa", [](const Measurement& r) { return r.interval.mean.se; },
          "Standard error of the pooled mean, kPa: the larger of two estimates (voxels that share noise; slices).")
      .def_property_readonly(
          "mean_ci95_kPa",
          [](const Measurement& r) { return py::make_tuple(r.interval.mean.low, r.interval.mean.high); },
          "95 % interval of the pooled mean, kPa.")
      .def_readonly("not_finite", &Measurement::notFinite, "Voxels left out: not finite.")
      .def_readonly("not_positive", &Measurement::notPositive, "Voxels left out: zero or less.")
      .def_readonly("low_confidence", &Measurement::lowConfidence,
                    "Voxels left out: below the threshold of confidence.")
      .def_readonly("no_confidence", &Measurement::noConfidence,
                    "Voxels left out: the confidence map says nothing of them.");
}

void bindRegion(py::module_& m) {
  py::class_<MeasuredRegion, std::shared_ptr<MeasuredRegion>>(m, "MeasuredRegion", "What measure() gives.")
      .def_property_readonly(
          "measurement", [](const MeasuredRegion& r) -> const elastography::Measurement& { return r.measurement; },
          "Measurement: the numbers.")
      .def_property_readonly(
          "stiffness", [](const MeasuredRegion& r) -> const image::ScalarVolume& { return r.mre.map.values_kPa; },
          "Volume: the elastogram, kPa, of the quantity that measurement.quantity names.")
      .def_property_readonly(
          "confidence",
          [](const MeasuredRegion& r) -> const image::ScalarVolume* {
            return r.mre.map.confidence ? &*r.mre.map.confidence : nullptr;
          },
          py::return_value_policy::reference_internal, "Volume: 0 to 1, on the same grid; None without one.")
      .def_property_readonly(
          "region", [](const MeasuredRegion& r) -> const image::Mask& { return r.region.mask; },
          "Mask: the region on the elastogram's grid, before erosion.")
      .def_property_readonly(
          "coverage", [](const MeasuredRegion& r) { return r.region.coverage; },
          "Share of the region's volume that the elastogram covers, 0 to 1.")
      .def_property_readonly(
          "mri_from_mre",
          [](const MeasuredRegion& r) -> std::optional<Eigen::Matrix4d> {
            if (!r.registration) return {};
            return Eigen::Matrix4d(r.registration->X_fixed_moving.matrix());
          },
          "4 x 4, LPS mm: the motion of register=True; else None.")
      .def_readonly("warnings", &MeasuredRegion::warnings, "What is doubtful: sentences.")
      .def_property_readonly(
          "diagnostics", [](const MeasuredRegion& r) { return listOf(r.diagnostics); }, "Diagnostics.");
}

}  // namespace

void bindMeasure(py::module_& m) {
  bindStatistics(m);
  bindRegion(m);
  m.def("measure", &measure, py::arg("mre"), py::arg("roi"), py::kw_only(), py::arg("mri") = py::none(),
        py::arg("quantity") = py::none(), py::arg("unit") = py::none(),
        py::arg("roles") = std::map<std::string, std::string>(), py::arg("override") = false,
        py::arg("label") = py::none(), py::arg("name") = "", py::arg("confidence") = py::none(),
        py::arg("confidence_scale") = py::none(), py::arg("erode_px") = 0, py::arg("erode_mm") = 0.0,
        py::arg("exclude") = py::none(), py::arg("register") = false, py::arg("magnitude") = py::none(),
        py::arg("poisson") = 0.5, py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "Stiffness statistics of a region of interest on an elastogram, per slice and pooled; the numbers of "
        "`glisson-cli measure`.\n\n"
        "mre: DICOM folder, DICOMDIR, ZIP archive or a stiffness map. roi: contour JSON, RT Structure Set, "
        "Segmentation, mask or "
        "closed surface. mri: image that the contours were drawn on, where its slices differ. quantity (\"shear\", "
        "\"youngs\") and "
        "unit (\"Pa\", \"kPa\", \"<factor>kPa\"): of a map that does not say. roles: as in scan(). override: other "
        "days or patients "
        "are meant. label: of a mask, 0 any. name: structure of an RT Structure Set. confidence: voxels below are left "
        "out, 0 to 1 "
        "[0.95]. confidence_scale: stored value of full confidence. erode_px, erode_mm: taken off the outline. "
        "exclude: mask of "
        "what is left out. register: lay the magnitude images over mri. poisson: for the other modulus [0.5].\n\n"
        "Raises BadInput, Cancelled.");
}

}  // namespace glisson::python
