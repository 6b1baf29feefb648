// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/text_file.h"

#include <array>
#include <charconv>
#include <fstream>

#include "base/error.h"
#include "base/part_file.h"

namespace glisson::exchange {

void writeTextFile(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
  const std::string name = file.filename().string();
  std::error_code ec;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ec);
  if (ec) throw BadInput("cannot make the folder of '" + name + "': " + ec.message());
  PartFile part(file);
  {
    std::ofstream out(part.path(), std::ios::binary);
    out.imbue(std::locale::classic());
    write(out);
    out.flush();
    if (!out) throw BadInput("cannot write '" + name + "'; is the disk full or the folder read-only?");
  }
  part.become();
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
  writeTextFile(file, [&](std::ostream& out) { out << text; });
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace glisson::exchange
