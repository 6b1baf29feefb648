// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "study/beam.h"

namespace glisson::study {

/// Writes the validation into a folder: validate-beam.csv with every row; error against run time for each of the three
/// references as PNG and SVG; report.html and report.pdf with the charts, the references, the goals and the rows.
/// Returns the files. Throws BadInput where the folder cannot be written.
std::vector<std::filesystem::path> writeBeamStudy(const std::filesystem::path& folder, const BeamStudy& study);

}  // namespace glisson::study
