// SPDX-License-Identifier: GPL-3.0-or-later

// libFuzzer target: layout, header and stored pixels of one file, all in this process, with the same code as in the
// reader process. Built with clang's -fsanitize=fuzzer,address.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "dicom/detail/image_header.h"
#include "dicom/detail/siemens.h"
#include "dicom/detail/stored_frames.h"
#include "dicom/file_layout.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glisson::dicom;
  static const std::string file =
      (std::filesystem::temp_directory_path() / ("glisson-fuzz-" + std::to_string(getpid()))).string();
  static std::FILE* const out = std::fopen(file.c_str(), "w+b");
  if (out == nullptr) return 0;
  std::rewind(out);
  if (ftruncate(fileno(out), 0) != 0 || (size > 0 && std::fwrite(data, 1, size, out) != size)) return 0;
  std::fflush(out);
  try {
    csaValues(data, size);
  } catch (const glisson::BadInput&) {
  }
  try {
    ByteSource source(file);
    const ImageHeader header = readImageHeader(file, source);
    StoredFrames frames(header, source);
    if (header.frameBytes() < (16U << 20)) frames.read(0);
  } catch (const RefusedFile&) {
  } catch (const glisson::BadInput&) {
  }
  return 0;
}
