// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/private_folder.h"
#include "dicom/file_layout.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// What reading an archive tells, entry by entry; begin and data return false to stop.
struct ArchiveEntries {
  std::function<bool(const std::string& name)> begin;
  std::function<bool(const char* bytes, std::size_t count)> data;
  std::function<void(const std::string& name, const std::string& reason)> refused;
};

/// Reads a ZIP archive with libarchive in this process; it decides nothing about sizes. Throws BadInput where the
/// archive is damaged.
void readArchive(ByteSource& source, const ArchiveEntries& entries);

/// Whether a file begins as a ZIP archive does.
bool looksLikeZip(const std::filesystem::path& file);

/// Unpacks a ZIP archive, read by a reader process, into a private folder. Entries keep their names where these are
/// plain relative paths; links, absolute paths, "..", archives in the archive and encrypted entries are left out, with
/// the reason. Refused as a whole (RefusedFile): more than 200,000 entries; more than 256 MiB and 100 times its size,
/// or than half of the free space of the temporary folder.
std::unique_ptr<PrivateFolder> unpackArchive(const std::filesystem::path& file, std::vector<SkippedFile>& skipped);

}  // namespace glisson::dicom
