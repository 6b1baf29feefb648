// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "roi/contour_stack.h"

namespace glisson::roi {

/// Contours as JSON, schema "glisson/contours/1" (resources/schemas/contours.schema.json). Vertices are LPS mm, written
/// with as many digits as a double needs, so that reading gives the same bits. Throws BadArgument where a coordinate is
/// not finite (JSON has no word for it).
std::string toJson(const ContourStack& contours);

/// The reverse. source: what to call the text in messages (a file name, never a patient's).
/// Throws BadInput that names the key for an unknown, missing or repeated key, a wrong type, a state that is not draft,
/// accepted or interpolated, fewer than three vertices (drafts may have fewer), and the line for text that is no JSON.
ContourStack contoursFromJson(const std::string& text, const std::string& source = "contours");

/// Reads a contour file. Throws BadInput as contoursFromJson does, and where the file cannot be read.
ContourStack readContours(const std::filesystem::path& file);

/// Writes a contour file: beside, synchronised, then renamed, so that a failure leaves the old file. Throws BadInput
/// where the folder cannot be written to.
void writeContours(const std::filesystem::path& file, const ContourStack& contours);

}  // namespace glisson::roi
