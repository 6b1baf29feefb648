// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "dicom/detail/image_header.h"

namespace glisson::dicom::detail {

/// A header as the message of a reader process.
std::string toMessage(ImageHeader header);

/// The header in a message, checked: sizes, counts, finite numbers, clean text. fileBytes: of the file that it speaks
/// of. Throws BadInput.
ImageHeader headerFrom(const std::string& message, std::uint64_t fileBytes);

/// Text that may be shown: no control characters, at most 600 bytes.
std::string shownFrom(std::string text);

}  // namespace glisson::dicom::detail
