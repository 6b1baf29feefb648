// SPDX-License-Identifier: GPL-3.0-or-later

// A first outline of an organ from one point inside it.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "bindings.h"
#include "convert.h"
#include "pipeline/outline_proposal.h"
#include "roi/contour_io.h"
#include "text.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using pipeline::OutlineProposal;

std::shared_ptr<OutlineProposal> propose(const std::filesystem::path& image, const Eigen::Vector3d& seed, bool index,
                                         double spread, double neck_mm, double closing_mm, double least_mL,
                                         double most_mL, const py::object& progress,
                                         const std::shared_ptr<Cancel>& cancel) {
  requirePositive("spread", spread);
  requireWithin("neck_mm", neck_mm, 0.0, 1e3);
  requireWithin("closing_mm", closing_mm, 0.0, 1e3);
  requireWithin("least_mL", least_mL, 0.0, 1e6);
  requirePositive("most_mL", most_mL);
  roi::ProposalOptions options;
  options.spread = spread;
  options.neck_mm = neck_mm;
  options.closing_mm = closing_mm;
  options.least_mL = least_mL;
  options.most_mL = most_mL;
  return awaited({progress, cancel}, [&](const Progress& p) {
    return std::make_shared<OutlineProposal>(pipeline::proposeOutline(image, {seed, index}, options, p));
  });
}

}  // namespace

void bindPropose(py::module_& m) {
  py::class_<OutlineProposal, std::shared_ptr<OutlineProposal>>(
      m, "Proposal", "A first outline, to be corrected by hand; never a result.")
      .def_property_readonly(
          "mask", [](const OutlineProposal& p) -> const image::Mask& { return p.proposal.mask; },
          "Mask on the image's grid.")
      .def_property_readonly(
          "volume_mL", [](const OutlineProposal& p) { return p.proposal.volume_mL; }, "Its volume, mL.")
      .def_property_readonly(
          "intensities", [](const OutlineProposal& p) { return py::make_tuple(p.proposal.low, p.proposal.high); },
          "Least and largest intensity accepted at the seed.")
      .def_property_readonly(
          "touches_border", [](const OutlineProposal& p) { return p.proposal.touchesBorder; },
          "It ends at the border of the image: cut off there, or leaked.")
      .def_readonly("seed_lps_mm", &OutlineProposal::seed_lps_mm, "The seed, LPS mm.")
      .def_readonly("warnings", &OutlineProposal::warnings, "What is to be told: sentences.")
      .def_property_readonly(
          "diagnostics", [](const OutlineProposal& p) { return listOf(p.diagnostics); }, "Diagnostics.")
      .def_property_readonly(
          "contours", [](const OutlineProposal& p) { return fromJson(roi::toJson(pipeline::contoursOf(p))); },
          "The outline as polygons: what a contour file (glisson/contours/1) holds, LPS mm.")
      .def(
          "write",
          [](const OutlineProposal& p, const std::filesystem::path& file) { pipeline::writeProposal(file, p); },
          py::arg("file"),
          "Writes contours (.json) or a mask (.nii, .nii.gz, .nrrd, .mha), as `glisson-cli propose` does. Raises "
          "BadInput.");
  const roi::ProposalOptions d;
  m.def("propose", &propose, py::arg("image"), py::arg("seed"), py::kw_only(), py::arg("index") = false,
        py::arg("spread") = d.spread, py::arg("neck_mm") = d.neck_mm, py::arg("closing_mm") = d.closing_mm,
        py::arg("least_mL") = d.least_mL, py::arg("most_mL") = d.most_mL, py::arg("progress") = py::none(),
        py::arg("cancel") = py::none(),
        "A first outline of an organ from one point inside it; that of `glisson-cli propose`.\n\n"
        "image: DICOM folder or a volume. seed: (x, y, z) in LPS mm, or a voxel index (i, j, k) with index=True. "
        "spread: intensities "
        "accepted, in robust standard deviations. neck_mm: bridges thinner than twice this are cut. closing_mm: gaps "
        "narrower than "
        "twice this are closed. least_mL, most_mL: sizes of an organ; anything else is refused.\n\nRaises BadInput, "
        "Cancelled.");
}

}  // namespace glisson::python
