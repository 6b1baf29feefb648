#include "base/private_folder.h"

#include <cstdlib>
#include <string>

#include "base/error.h"

namespace glisson {

PrivateFolder::PrivateFolder() {
  std::error_code failed;
  const std::filesystem::path base = std::filesystem::temp_directory_path(failed);
  // mkdtemp replaces the last six characters.
  std::string pattern = (base / ("glisson-" + std::string(6, 'X'))).string();
  if (failed || !mkdtemp(pattern.data()))
    throw BadInput("there is no temporary folder that may be written to; is the disk full? TMPDIR names another one");
  path_ = pattern;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace glisson
