// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <new>
#include <string>

#include "base/error.h"
#include "dicom/detail/image_header.h"

namespace glisson::dicom::detail {

/// What work() gives. Whatever it refuses becomes a BadInput that begins with the name of the file.
template <class Work>
auto naming(const std::filesystem::path& file, Work&& work) -> decltype(work()) {
  const std::string which = "'" + file.filename().string() + "' ";
  try {
    return work();
  } catch (const RefusedFile& e) {
    throw BadInput(which + e.reason);
  } catch (const BadInput& e) {
    throw BadInput(which + e.what());
  } catch (const std::bad_alloc&) {
    throw BadInput(which + "does not fit into memory");
  }
}

}  // namespace glisson::dicom::detail
