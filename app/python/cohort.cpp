// SPDX-License-Identifier: GPL-3.0-or-later

// Many patients: synthetic ones, and the studies over a folder of them.
#include "cohort/cohort.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "await.h"
#include "base/error.h"
#include "bindings.h"
#include "convert.h"
#include "phantom/phantom.h"

namespace glisson::python {
namespace py = pybind11;
namespace {

using cohort::CaseOutcome;
using cohort::CohortOptions;
using cohort::CohortResult;
using Path = std::filesystem::path;

/// glisson-cli, which runs each patient in a process of its own; set by the package when it is imported.
Path& commandLine() {
  static Path program;
  return program;
}

Path programOr(const std::optional<Path>& given) {
  const Path program = given.value_or(commandLine());
  if (program.empty())
    throw BadInput(
        "a cohort runs each patient by glisson-cli, which does not lie where this module looks; give its path as "
        "program");
  return program;
}

std::shared_ptr<CohortResult> runCohort(const Path& patients, const Path& output, const std::optional<Path>& scene,
                                        int jobs, const std::pair<int, int>& shard, bool asPublished, bool reports,
                                        bool sensitivity, bool howSure, const std::optional<Path>& program,
                                        const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  CohortOptions options;
  options.output = output;
  options.executable = programOr(program);
  options.scene = scene;
  options.jobs = jobs;
  options.shard = shard.first;
  options.shards = shard.second;
  options.asPublished = asPublished;
  options.reports = reports;
  options.uncertainty = howSure;
  options.sensitivity = sensitivity;
  return awaited({progress, cancel}, [&](const Progress& p) {
    return std::make_shared<CohortResult>(cohort::runCohort(patients, options, p));
  });
}

std::shared_ptr<CohortResult> mergeCohort(const std::vector<Path>& shards, const Path& output,
                                          const std::optional<Path>& patients, const std::optional<Path>& scene,
                                          int jobs, bool asPublished, bool sensitivity,
                                          const std::optional<Path>& program, const py::object& progress,
                                          const std::shared_ptr<Cancel>& cancel) {
  CohortOptions options;
  options.output = output;
  options.executable = programOr(program);
  options.scene = scene;
  options.jobs = jobs;
  options.asPublished = asPublished;
  options.sensitivity = sensitivity;
  return awaited({progress, cancel}, [&](const Progress& p) {
    return std::make_shared<CohortResult>(cohort::mergeCohort(shards, patients.value_or(Path()), options, p));
  });
}

std::vector<Path> writePatients(const Path& output, int cases, std::uint64_t seed, bool paper, const std::string& shape,
                                const py::object& progress, const std::shared_ptr<Cancel>& cancel) {
  phantom::PhantomOptions options;
  options.cases = cases;
  options.seed = seed;
  options.paperCohort = paper;
  const auto named = phantom::liverShapeNamed(shape);
  if (!named)
    throw BadInput("there is no shape \"" + shape.substr(0, 40) + "\"; glisson-cli phantom --help lists them");
  options.shape = *named;
  return awaited({progress, cancel}, [&](const Progress& p) { return phantom::writeCohort(options, output, p); });
}

std::string nameOf(CaseOutcome::Status status) {
  switch (status) {
    case CaseOutcome::Status::Done: return "done";
    case CaseOutcome::Status::Rejected: return "rejected";
    case CaseOutcome::Status::Failed: return "failed";
  }
  return "";
}

void bindResults(py::module_& m) {
  py::class_<CaseOutcome>(m, "CaseOutcome", "What became of one patient of a cohort.")
      .def_readonly("id", &CaseOutcome::id, "By number, e.g. \"case-001\"; no name.")
      .def_property_readonly(
          "status", [](const CaseOutcome& c) { return nameOf(c.status); }, "\"done\", \"rejected\" or \"failed\".")
      .def_readonly("reason", &CaseOutcome::reason, "A sentence; empty where done.")
      .def_readonly("resumed", &CaseOutcome::resumed, "It was there already.");
  py::class_<CohortResult, std::shared_ptr<CohortResult>>(m, "Cohort",
                                                          "What the studies over a folder of patients give.")
      .def_readonly("cases", &CohortResult::cases, "CaseOutcome of every patient.")
      .def_readonly("files", &CohortResult::files, "Everything written.")
      .def_property_readonly(
          "record",
          [](const CohortResult& r) -> py::object {
            if (r.json.empty()) return py::none();
            return fromJson(r.json);
          },
          "cohort.json: the numbers of all studies; None for a shard. Parsed at each call.")
      .def_property_readonly("complete", &CohortResult::complete,
                             "Whether no patient was left out (else the command line's exit code 6).");
}

}  // namespace

void bindCohort(py::module_& m) {
  bindResults(m);
  m.def(
      "_set_command_line", [](const Path& program) { commandLine() = program; }, py::arg("program"),
      "glisson-cli, which cohort() runs.");
  m.def("cohort", &runCohort, py::arg("patients"), py::arg("output"), py::kw_only(), py::arg("scene") = py::none(),
        py::arg("jobs") = 0, py::arg("shard") = std::pair(1, 1), py::arg("as_published") = false,
        py::arg("reports") = false, py::arg("sensitivity") = true, py::arg("uncertainty") = false,
        py::arg("program") = py::none(), py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
        "The paper's studies over a folder with one folder per patient; those of `glisson-cli cohort`, which goes on "
        "where it was "
        "stopped.\n\n"
        "output: folder for results. scene: template whose geometry is replaced by each patient's. jobs: patients at a "
        "time, 0 what "
        "cores and memory allow. shard: (i, n) takes only every n-th patient, for merge_cohort. as_published: "
        "histogram of Young's "
        "moduli. reports: a report of every patient. sensitivity: the chosen four under other assumptions. "
        "uncertainty: say how sure every patient is, and give the shares their intervals. program: glisson-cli, "
        "which runs each patient in a process of its own; None: the one that belongs to this module.\n\n"
        "Patients that are left out raise nothing: see Cohort.cases. Raises BadInput, Cancelled.");
  m.def(
      "merge_cohort", &mergeCohort, py::arg("shards"), py::arg("output"), py::kw_only(),
      py::arg("patients") = py::none(), py::arg("scene") = py::none(), py::arg("jobs") = 0,
      py::arg("as_published") = false, py::arg("sensitivity") = true, py::arg("program") = py::none(),
      py::arg("progress") = py::none(), py::arg("cancel") = py::none(),
      "Puts the outputs of all shards together and summarises them: the bytes that one machine would have written. "
      "patients: the "
      "folder of patients again, for the pictures and the sensitivity of the chosen four. Raises BadInput, Cancelled.");
  m.def("phantom", &writePatients, py::arg("output"), py::kw_only(), py::arg("cases") = 1, py::arg("seed") = 1,
        py::arg("paper") = false, py::arg("shape") = "usual", py::arg("progress") = py::none(),
        py::arg("cancel") = py::none(),
        "Writes synthetic patients as DICOM, each with scene.json and truth.json; returns their folders. paper: "
        "stiffness drawn as "
        "in the published cohort. The same seed gives the same bytes. Raises BadInput, Cancelled.");
}

}  // namespace glisson::python
