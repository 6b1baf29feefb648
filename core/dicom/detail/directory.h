// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dicom/file_layout.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// The files that a DICOMDIR lists, each as the parts of its path from the DICOMDIR's folder on. Parses with DCMTK in
/// this process. Throws BadInput where the file is no DICOMDIR.
std::vector<std::vector<std::string>> readDirectory(ByteSource& source);

/// The files that a DICOMDIR lists and that are there, in its order; what is missing, lies outside of its folder or is
/// a link goes to skipped. Names are found whatever their case and with the endings that discs give them ("." and
/// ";1"). Throws RefusedFile where the DICOMDIR cannot be read.
std::vector<std::filesystem::path> listedFiles(const std::filesystem::path& dicomdir,
                                               std::vector<SkippedFile>& skipped);

}  // namespace glisson::dicom
