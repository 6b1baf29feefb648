// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "dicom/series.h"

namespace glisson::cli {

/// "--role UID=stiffness" (or series number=role), once for each series. Throws BadInput for anything else.
inline dicom::RoleOverrides rolesFrom(const std::vector<std::string>& given) {
  dicom::RoleOverrides roles;
  for (const std::string& one : given) {
    const std::size_t at = one.find('=');
    if (at == 0 || at == std::string::npos)
      throw BadInput("--role '" + one.substr(0, 80) + "' is no series=role, e.g. 1.2.840.1=stiffness or 401=wave");
    roles[one.substr(0, at)] = dicom::roleNamed(one.substr(at + 1));
  }
  return roles;
}

}  // namespace glisson::cli
