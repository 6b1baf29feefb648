// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dicom/detail/image_header.h"

namespace glisson::dicom::detail {

bool isJpeg2000(const std::string& transferSyntax);

/// The fragments of a frame: one each, or all of them where there is one frame.
std::span<const Fragment> fragmentsOf(const ImageHeader& header, int frame);

/// Their bytes, at most so many.
std::vector<std::uint8_t> bytesOf(std::span<const Fragment> fragments, const ByteSource& source, std::uint64_t most);

/// Looks at the code streams of compressed pixels before a decoder does. Throws BadInput where one holds no image of
/// the size that the header says, or where it cannot be told which fragments belong together.
void checkCodeStreams(const ImageHeader& header, const ByteSource& source);

}  // namespace glisson::dicom::detail
