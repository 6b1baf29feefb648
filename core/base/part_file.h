// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace glisson {

/// A new file beside the one that it is to become, of a name that nobody can foresee, and made only where nothing of
/// that name lies (no link is followed). Removed by the destructor unless it has become the file.
class PartFile {
 public:
  /// ending: for libraries that choose a format by it, e.g. ".nii.gz". Throws BadInput that names the file and the
  /// reason (no folder, no rights, full disk).
  explicit PartFile(std::filesystem::path file, const std::string& ending = {});
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Appends. Throws BadInput as above.
  void write(const void* bytes, std::size_t count);

  /// Synchronises what lies at path() (which a library may have written), renames it to the file, and synchronises the
  /// folder: at any moment there is the old file or the new one, whole. Throws BadInput as above.
  void become();

 private:
  void close();

  std::filesystem::path file_, path_;
  int descriptor_ = -1;
  bool there_ = false;
};

}  // namespace glisson
