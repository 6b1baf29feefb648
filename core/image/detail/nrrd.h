// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/diagnostic.h"
#include "image/detail/text_header.h"
#include "image/grid.h"

namespace glisson::image::detail {

/// Reads and checks an NRRD header before a library sees the file: dimension and sizes, the length of every per-axis
/// field, skips, and the bytes that they ask for against the bytes there are. Throws BadInput, naming the file; also
/// for layered segmentations of 3D Slicer (saying how to save them) and for a space without directions.
TextHeader checkedNrrd(const std::filesystem::path& file);

/// What ITK passes over: lengths in other units than millimetres are scaled; a header without a place in the patient is
/// put into doubts (may be null). Throws BadInput for a unit of length that is not known.
void completeNrrd(const TextHeader& header, const std::filesystem::path& file, Grid& grid, Diagnostics* doubts);

}  // namespace glisson::image::detail
