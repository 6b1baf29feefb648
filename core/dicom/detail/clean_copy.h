// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// For .cpp files of this room only, after DCMTK's own headers.
#include <filesystem>

#include "dicom/file_layout.h"

namespace glisson::dicom {

/// Header through DCMTK, pixels as they lie in the source, at the source's transfer syntax (inflated where deflated).
/// Throws BadInput where the source's pixels are not whole, Error where the file cannot be written.
void writeCleanCopy(DcmDataset& data, const ByteSource& source, const FileLayout& layout,
                    const std::filesystem::path& file);

}  // namespace glisson::dicom
