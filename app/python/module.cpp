// SPDX-License-Identifier: GPL-3.0-or-later

// The Python module glisson._core: wiring only, as in the other programs. glisson/__init__.py names what is public.
#include "base/parallel.h"
#include "base/version.h"
#include "bindings.h"
#include "dicom/series.h"

#include <pybind11/stl/filesystem.h>

PYBIND11_MODULE(_core, m) {
  using namespace glisson::python;
  namespace py = pybind11;
  m.doc() = "Glisson's core. Import glisson, not this module.";
  bindErrors(m);
  bindCancel(m);
  bindDiagnostics(m);
  bindImages(m);
  bindScan(m);
  bindMeasure(m);
  bindInvert(m);
  bindPropose(m);
  bindScene(m);
  bindRetraction(m);
  bindRun(m);
  bindLive(m);
  bindCohort(m);
  m.def("version", &glisson::version, "Version of the software, e.g. \"0.1.0\".");
  m.def("set_threads", &glisson::setThreadCount, py::arg("threads"),
        "Threads that core uses from now on; 0 is one per core. Results do not depend on it. Raises BadArgument below "
        "0.");
  m.def("threads", &glisson::threadCount, "Threads that core uses.");
  m.def("_set_reader_program", &glisson::dicom::setReaderProgram, py::arg("program"),
        "The program that decodes DICOM files that are not plain.");
  m.attr("research_use_only") = glisson::researchUseOnly;
}
