// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/quantity.h"
#include "dicom/series.h"
#include "session/parameters.h"

namespace glisson::session {

/// What the reader has corrected or confirmed about the images that are open; the scene says the same, so that the
/// command line takes them alike.
struct Choices {
  std::vector<std::string> files;  ///< of the folder that was opened: only these, relative to it; empty: all
  dicom::RoleOverrides roles;      ///< of series, set by hand
  std::optional<bool> together;    ///< MRI and elastogram differ in patient, day or frame: used all the same?
  std::optional<StiffnessQuantity> quantity;  ///< of an elastogram that does not say so itself
  std::optional<std::string> unit;            ///< and its unit, as elastography::unitFactor_kPa takes it
  bool otherFrame = false;                    ///< outlines of another frame of reference than the MRI's are meant
  bool operator==(const Choices&) const = default;
};

/// How stiffness is measured: by default without the edge of the liver, where the map mixes in what lies beside it, and
/// without vessels [qiba2022mre].
struct MeasureSettings {
  bool innerRoi = true;
  int erosion_pixels = 3;  ///< of the elastogram, where innerRoi is on
  bool vessels = true;     ///< vessels that are found in the MRI are left out
  bool operator==(const MeasureSettings&) const = default;
};

/// What a case holds beside its outlines.
struct Settings {
  Choices choices;
  Parameters parameters;
  MeasureSettings measure;
  bool operator==(const Settings&) const = default;
};

}  // namespace glisson::session
