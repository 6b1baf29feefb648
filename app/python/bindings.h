// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace glisson::python {

// One function per room of the module; module.cpp calls them in this order, so that a docstring names types that are
// known already.
void bindErrors(pybind11::module_& m);
void bindCancel(pybind11::module_& m);
void bindDiagnostics(pybind11::module_& m);
void bindImages(pybind11::module_& m);
void bindScan(pybind11::module_& m);
void bindMeasure(pybind11::module_& m);
void bindInvert(pybind11::module_& m);
void bindPropose(pybind11::module_& m);
void bindScene(pybind11::module_& m);
void bindRetraction(pybind11::module_& m);
void bindRun(pybind11::module_& m);
void bindLive(pybind11::module_& m);
void bindCohort(pybind11::module_& m);

}  // namespace glisson::python
