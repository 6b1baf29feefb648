// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"

#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/part_file.h"

namespace glisson {

namespace {

constexpr std::uintmax_t largest_bytes = 256u << 20;

}  // namespace

void writeAtomically(const std::filesystem::path& file, const std::string& text) {
  PartFile part(file);
  part.write(text.data(), text.size());
  part.become();
}

std::string readWhole(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > largest_bytes)
    throw BadInput("'" + file.filename().string() + "' is larger than 256 MB; it is not read as text");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || error) throw BadInput("cannot read '" + file.filename().string() + "'; check that it is there");
  return text.str();
}

}  // namespace glisson
