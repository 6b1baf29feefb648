// SPDX-License-Identifier: GPL-3.0-or-later

// Geometry and voxel volumes: affines in LPS and RAS, values as arrays without a copy.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <string>

#include "arrays.h"
#include "base/diagnostic.h"
#include "base/error.h"
#include "base/frames.h"
#include "bindings.h"
#include "image/io.h"
#include "inversion/waves.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

Eigen::Matrix4d affineLps(const image::Grid& g) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Identity();
  a.topLeftCorner<3, 3>() = g.direction * g.spacing_mm.asDiagonal();
  a.topRightCorner<3, 1>() = g.origin_lps_mm;
  return a;
}

Eigen::Matrix4d affineRas(const image::Grid& g) {
  Eigen::Matrix4d a = affineLps(g);
  for (int column = 0; column < 4; ++column) a.block<3, 1>(0, column) = lpsToRas(a.block<3, 1>(0, column));
  return a;
}

/// Throws BadInput for axes that are not orthogonal, or a grid that no image has (image::Grid::check).
image::Grid gridOf(const Eigen::Vector3i& size, const Eigen::Matrix4d& affine_lps) {
  image::Grid g;
  g.size = size;
  g.spacing_mm = affine_lps.topLeftCorner<3, 3>().colwise().norm();
  g.direction = affine_lps.topLeftCorner<3, 3>() * g.spacing_mm.cwiseInverse().asDiagonal();
  g.origin_lps_mm = affine_lps.topRightCorner<3, 1>();
  g.check();
  return g;
}

Eigen::Vector3i sizeOf(const py::array& values) {
  if (values.ndim() != 3)
    throw BadArgument("values have " + std::to_string(values.ndim()) + " axes; give array[i, j, k]");
  return {static_cast<int>(values.shape(0)), static_cast<int>(values.shape(1)), static_cast<int>(values.shape(2))};
}

/// Copies an array[i, j, k] of any memory order.
template <typename T, typename Given>
image::Volume<T> volumeOf(const py::array_t<Given, py::array::f_style | py::array::forcecast>& values,
                          const Eigen::Matrix4d& affine_lps) {
  image::Volume<T> v(gridOf(sizeOf(values), affine_lps));
  std::copy(values.data(), values.data() + values.size(), v.values.begin());
  return v;
}

std::string describe(const image::Grid& g) {
  const auto three = [](const auto& v) {
    return "(" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + ")";
  };
  return "size " + three(g.size) + ", spacing " + three(g.spacing_mm) + " mm";
}

/// What every volume has: its grid, and the affines once more, where they are looked for.
template <typename V>
py::class_<V, std::shared_ptr<V>> volumeClass(py::module_& m, const char* name, const char* doc) {
  py::class_<V, std::shared_ptr<V>> c(m, name, doc);
  c.def_property_readonly(
      "grid", [](const V& v) { return v.grid; }, "Grid: where the voxels lie.");
  c.def_property_readonly(
      "affine_lps", [](const V& v) { return affineLps(v.grid); },
      "4 x 4: index (i, j, k, 1) to millimetres in LPS, as Grid.affine_lps.");
  c.def_property_readonly(
      "affine_ras", [](const V& v) { return affineRas(v.grid); },
      "4 x 4: index (i, j, k, 1) to millimetres in RAS, as nibabel has it.");
  c.def("__repr__",
        [name = std::string(name)](const V& v) { return "<glisson." + name + " " + describe(v.grid) + ">"; });
  return c;
}

void bindGrid(py::module_& m) {
  py::class_<image::Grid>(m, "Grid",
                          "A regular lattice of voxels in the patient's frame, LPS (x to the patient's left, y to "
                          "posterior, z to superior), mm. An integer index is a voxel's centre.")
      .def(py::init(&gridOf), py::arg("size"), py::arg("affine_lps"),
           "size: voxels along i, j, k. affine_lps: 4 x 4, index to LPS mm. Raises BadInput where the axes are not "
           "orthogonal.")
      .def_property_readonly(
          "size", [](const image::Grid& g) { return py::make_tuple(g.size.x(), g.size.y(), g.size.z()); },
          "Voxels along i, j, k.")
      .def_property_readonly(
          "spacing_mm", [](const image::Grid& g) { return g.spacing_mm; }, "Edges of a voxel, mm.")
      .def_property_readonly(
          "origin_lps_mm", [](const image::Grid& g) { return g.origin_lps_mm; }, "Centre of voxel (0, 0, 0), LPS mm.")
      .def_property_readonly(
          "direction", [](const image::Grid& g) { return g.direction; },
          "3 x 3: columns are the unit vectors of the axes i, j, k in LPS.")
      .def_property_readonly("affine_lps", &affineLps, "4 x 4: index (i, j, k, 1) to millimetres in LPS.")
      .def_property_readonly("affine_ras", &affineRas,
                             "4 x 4: index (i, j, k, 1) to millimetres in RAS (nibabel, NIfTI).")
      .def("__repr__", [](const image::Grid& g) { return "<glisson.Grid " + describe(g) + ">"; });
}

void bindVolumes(py::module_& m) {
  volumeClass<image::ScalarVolume>(m, "Volume",
                                   "Numbers on a grid; what they are and their unit is said where one is given.")
      .def(py::init(&volumeOf<float, float>), py::arg("values"), py::arg("affine_lps"),
           "values: array[i, j, k], copied as 32-bit floats. affine_lps: 4 x 4, index to LPS mm.")
      .def_property_readonly(
          "values", [](py::object self) { return viewOf<float>(self.cast<const image::ScalarVolume&>(), self); },
          "array[i, j, k] of 32-bit floats; read-only, no copy, in Fortran order.")
      .def(
          "write", [](const image::ScalarVolume& v, const std::filesystem::path& file) { image::writeVolume(file, v); },
          py::arg("file"), "Writes .nii, .nii.gz, .nrrd or .mha. Raises BadInput where it cannot be written.");
  volumeClass<image::Mask>(m, "Mask", "Voxels that are inside a region.")
      .def(py::init(&volumeOf<std::uint8_t, bool>), py::arg("values"), py::arg("affine_lps"),
           "values: array[i, j, k], true inside; copied. affine_lps: 4 x 4, index to LPS mm.")
      .def_property_readonly(
          "values", [](py::object self) { return viewOf<bool>(self.cast<const image::Mask&>(), self); },
          "array[i, j, k] of bool; read-only, no copy, in Fortran order.")
      .def(
          "write", [](const image::Mask& v, const std::filesystem::path& file) { image::writeVolume(file, v); },
          py::arg("file"), "Writes .nii, .nii.gz, .nrrd or .mha (8 bit). Raises BadInput where it cannot be written.");
  volumeClass<image::DisplacementField>(m, "DisplacementField",
                                        "How far the material that rests at each voxel's centre has moved.")
      .def_property_readonly(
          "values", [](py::object self) { return viewOf(self.cast<const image::DisplacementField&>(), self); },
          "array[i, j, k, 3] of 32-bit floats: components along L, P, S in mm; 0 outside the body. "
          "Read-only, no copy.")
      .def(
          "write",
          [](const image::DisplacementField& v, const std::filesystem::path& file) { image::writeVolume(file, v); },
          py::arg("file"), "Writes .nrrd or .mha. Raises BadInput where it cannot be written.");
  volumeClass<inversion::ComplexVolume>(m, "ComplexVolume",
                                        "Complex amplitude U of a wave, u(t) = Re(U exp(i w t)), rad of phase.")
      .def_property_readonly(
          "values",
          [](py::object self) {
            return viewOf<std::complex<float>>(self.cast<const inversion::ComplexVolume&>(), self);
          },
          "array[i, j, k] of complex64; read-only, no copy, in Fortran order.");
  m.def(
      "read_volume", [](const std::filesystem::path& file) { return image::readVolume(file); }, py::arg("file"),
      "Reads NIfTI (.nii, .nii.gz), NRRD or MetaImage into a Volume, values scaled as the header says, geometry in LPS "
      "mm. "
      "Raises BadInput.");
  m.def(
      "read_mask", [](const std::filesystem::path& file, int label) { return image::readMask(file, label); },
      py::arg("file"), py::arg("label") = 0,
      "Voxels equal to label (0: any that is not zero) of such a file as a Mask. Raises BadInput.");
}

}  // namespace

std::vector<Eigen::Vector3d> pointsOf(const py::array_t<double, py::array::c_style | py::array::forcecast>& a) {
  if (a.ndim() != 2 || a.shape(1) != 3) throw BadArgument("points are an array[n, 3] of millimetres in LPS");
  std::vector<Eigen::Vector3d> points;
  for (py::ssize_t i = 0; i < a.shape(0); ++i) points.emplace_back(a.at(i, 0), a.at(i, 1), a.at(i, 2));
  return points;
}

void bindImages(py::module_& m) {
  bindGrid(m);
  bindVolumes(m);
}

void bindDiagnostics(py::module_& m) {
  py::class_<Diagnostic>(m, "Diagnostic",
                         "One fact about an input or a result; the manual's page of messages says what to do.")
      .def_property_readonly(
          "code", [](const Diagnostic& d) { return std::string(nameOf(d.code)); }, "E.g. \"difference-withheld\".")
      .def_property_readonly(
          "severity", [](const Diagnostic& d) { return std::string(nameOf(d.severity())); },
          "\"note\", \"warning\" or \"error\".")
      .def_property_readonly("text", &Diagnostic::text, "A sentence.")
      .def_property_readonly(
          "arguments",
          [](const Diagnostic& d) {
            py::dict arguments;
            for (const auto& [name, value] : d.arguments) arguments[py::str(name)] = py::cast(value);
            return arguments;
          },
          "The numbers and words of the sentence, by name.")
      .def("__repr__", [](const Diagnostic& d) {
        return "<glisson.Diagnostic " + std::string(nameOf(d.severity())) + " " + std::string(nameOf(d.code)) + ">";
      });
}

}  // namespace glisson::python
