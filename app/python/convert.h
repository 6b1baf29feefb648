// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "dicom/series.h"

namespace glisson::python {

/// Diagnostics as a list of Diagnostic, in the order in which they arose.
inline std::vector<Diagnostic> listOf(const Diagnostics& all) {
  return {all.begin(), all.end()};
}

/// {series UID or number: role} as given. Throws BadInput with the names of roles for an unknown one.
inline dicom::RoleOverrides rolesOf(const std::map<std::string, std::string>& given) {
  dicom::RoleOverrides roles;
  for (const auto& [series, role] : given) roles[series] = dicom::roleNamed(role);
  return roles;
}

/// JSON text as Python's own objects.
inline pybind11::object fromJson(const std::string& text) {
  return pybind11::module_::import("json").attr("loads")(text);
}

}  // namespace glisson::python
