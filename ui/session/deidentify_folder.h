// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "dicom/deidentify.h"

namespace glisson::session {

struct DeidentifyWish {
  std::filesystem::path in;   ///< DICOM folder or file; never written to
  std::filesystem::path out;  ///< new or empty
  std::filesystem::path key;  ///< of the project; made where it is missing; outside of both
  dicom::DeidentifyOptions options;
};

/// What became of the files, without a name of any.
struct DeidentifyReport {
  std::size_t files = 0, patients = 0;
  bool keyMade = false;  ///< there was none: new pseudonyms
  dicom::AttributeChanges changes;
  struct LeftOut {
    std::string reason;
    std::size_t files = 0;
  };
  std::vector<LeftOut> leftOut;    ///< the most frequent reason first
  std::vector<std::string> notes;  ///< of core, in its words
};

/// dicom::deidentify for the window. Throws BadInput as that and openProjectKey do; Cancelled. Whatever ends it early,
/// the folder is empty again: half of a patient would pass for all of one.
DeidentifyReport deidentifyFolder(const DeidentifyWish& wish, const Progress& progress = {});

}  // namespace glisson::session
