// SPDX-License-Identifier: GPL-3.0-or-later

// What lies in a folder of DICOM files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "bindings.h"
#include "convert.h"
#include "dicom/acquisitions.h"
#include "pipeline/sources.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using Scan = std::shared_ptr<dicom::ScanResult>;

/// An acquisition, and the scan that its series are of.
struct AcquisitionOfScan {
  dicom::Acquisition it;
  Scan in;
};

Scan scan(const std::filesystem::path& path, const std::map<std::string, std::string>& roles,
          const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  const dicom::RoleOverrides given = rolesOf(roles);
  return awaited({progress, cancel}, [&](const Progress& p) {
    auto found = std::make_shared<dicom::ScanResult>(dicom::scan(path, p));
    pipeline::checkRolesFound(given, {dicom::applyRoles(*found, given)});
    return found;
  });
}

std::vector<AcquisitionOfScan> acquisitionsOf(const Scan& found) {
  std::vector<AcquisitionOfScan> all;
  for (dicom::Acquisition& a : dicom::acquisitions(*found)) all.push_back({std::move(a), found});
  return all;
}

/// Series number i of the scan, kept alive by `self`; None where i is negative.
py::object seriesAt(py::handle self, int i) {
  if (i < 0) return py::none();
  const Scan& in = self.cast<const AcquisitionOfScan&>().in;
  return py::cast(in->series[static_cast<std::size_t>(i)], py::return_value_policy::reference_internal, self);
}

py::list seriesAt(py::handle self, const std::vector<int>& places) {
  py::list all;
  for (const int i : places) all.append(seriesAt(self, i));
  return all;
}

void bindSeries(py::module_& m) {
  using dicom::Series;
  py::class_<Series>(m, "Series", "One volume's worth of DICOM files. Nothing of it says who the patient is.")
      .def_readonly("uid", &Series::uid, "SeriesInstanceUID; with \"#2\" ... where one UID holds several volumes.")
      .def_property_readonly(
          "role", [](const Series& s) { return dicom::name(s.role); },
          "\"anatomical\", \"magnitude\", \"wave\", \"stiffness\", \"confidence\", \"colour-copy\", \"phase\" or "
          "\"other\".")
      .def_readonly("role_reason", &Series::roleReason, "Why this role: a sentence.")
      .def_readonly("description", &Series::description, "SeriesDescription.")
      .def_readonly("modality", &Series::modality, "Modality, e.g. \"MR\".")
      .def_readonly("number", &Series::number, "SeriesNumber.")
      .def_readonly("grid", &Series::grid, "Grid: where its voxels lie, LPS mm.")
      .def_readonly("unit", &Series::unit, "Unit of its values where the files say so, e.g. \"Pa\"; else None.")
      .def_readonly("vibration_Hz", &Series::vibration_Hz, "Frequency of a raw elastography acquisition, where told.")
      .def_readonly("lossy", &Series::lossy, "Compressed with loss: values are not the measured ones.")
      .def_readonly("warnings", &Series::warnings, "What is doubtful about it: sentences.")
      .def_property_readonly(
          "diagnostics", [](const Series& s) { return listOf(s.diagnostics); }, "The same as data.")
      .def_readonly("error", &Series::error, "Why it cannot be read as a volume; else None.")
      .def(
          "read",
          [](const Series& s, const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
            return awaited({progress, cancel}, [&](const Progress& p) { return dicom::readSeries(s, p); });
          },
          py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
          "Its values as a Volume, in the unit of the files, with the rescale applied. Raises BadInput, Cancelled.")
      .def("__repr__", [](const Series& s) {
        return "<glisson.Series " + std::to_string(s.number) + " " + dicom::name(s.role) + ">";
      });
}

void bindAcquisition(py::module_& m) {
  py::class_<AcquisitionOfScan>(m, "Acquisition", "The products of one elastography acquisition.")
      .def_property_readonly(
          "magnitude",
          [](py::object self) { return seriesAt(self, self.cast<const AcquisitionOfScan&>().it.magnitude); },
          "Series, or None.")
      .def_property_readonly(
          "stiffness",
          [](py::object self) { return seriesAt(self, self.cast<const AcquisitionOfScan&>().it.stiffness); },
          "Series, or None.")
      .def_property_readonly(
          "confidence",
          [](py::object self) { return seriesAt(self, self.cast<const AcquisitionOfScan&>().it.confidence); },
          "Series, or None.")
      .def_property_readonly(
          "wave", [](py::object self) { return seriesAt(self, self.cast<const AcquisitionOfScan&>().it.wave); },
          "Series of the wave images, in their order.")
      .def_property_readonly(
          "other_stiffness",
          [](py::object self) { return seriesAt(self, self.cast<const AcquisitionOfScan&>().it.otherStiffness); },
          "Masked copies and the like.")
      .def_property_readonly(
          "why", [](const AcquisitionOfScan& a) { return a.it.why; }, "What ties them together, in words.")
      .def_property_readonly(
          "diagnostics", [](const AcquisitionOfScan& a) { return listOf(a.it.diagnostics); },
          "What is doubtful about it.");
}

}  // namespace

void bindScan(py::module_& m) {
  bindSeries(m);
  bindAcquisition(m);
  py::class_<dicom::SkippedFile>(m, "SkippedFile", "A file that takes no part, and why.")
      .def_readonly("file", &dicom::SkippedFile::file, "Its path.")
      .def_readonly("reason", &dicom::SkippedFile::reason, "A sentence.");
  py::class_<dicom::ScanResult, Scan>(m, "Scan", "What a folder of DICOM files holds.")
      .def_property_readonly(
          "series",
          [](py::object self) {
            py::list all;
            for (const dicom::Series& s : self.cast<const Scan&>()->series)
              all.append(py::cast(s, py::return_value_policy::reference_internal, self));
            return all;
          },
          "Every Series, by number.")
      .def_readonly("skipped", &dicom::ScanResult::skipped, "Files that take no part, each with the reason.")
      .def_property_readonly("acquisitions", &acquisitionsOf,
                             "What belongs together: one Acquisition for each stiffness series.");
  m.def("scan", &scan, py::arg("path"), py::arg("roles") = std::map<std::string, std::string>(),
        py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "Lists the series of a DICOM folder, file, DICOMDIR or ZIP archive: roles with reasons, geometry, warnings, "
        "and every file "
        "that was left aside. roles: {series UID or number as text: role}, set by hand. A folder without images gives "
        "an empty "
        "list. Raises BadInput, Cancelled.");
}

}  // namespace glisson::python
