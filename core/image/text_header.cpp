// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/detail/text_header.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/text.h"

namespace glisson::image::detail {
namespace {

constexpr std::size_t longestLine = 1U << 16, mostLines = 2000;

std::string quoted(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

std::string trimmed(const std::string& s) {
  const std::size_t first = s.find_first_not_of(" \t\r");
  return first == std::string::npos ? std::string() : s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

/// Lines one after the other, none longer than a header's may be.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file), in_(file, std::ios::binary) {
    if (!in_) throw BadInput(quoted(file) + " cannot be opened");
  }
  bool next(std::string& line) {
    if (++count_ > mostLines) throw BadInput(quoted(file_) + " has a header of more than 2000 lines: it is damaged");
    line.clear();
    for (int c = in_.get(); c != std::ifstream::traits_type::eof(); c = in_.get()) {
      ++bytes_;
      if (c == '\n') return true;
      line.push_back(static_cast<char>(c));
      if (line.size() > longestLine)
        throw BadInput(quoted(file_) + " has a header line of more than 64 KiB: it is damaged, or another format");
    }
    return !line.empty();
  }
  std::uintmax_t bytes() const { return bytes_; }

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  std::size_t count_ = 0;
  std::uintmax_t bytes_ = 0;
};

}  // namespace

std::string TextHeader::field(const std::string& name) const {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

std::optional<std::vector<double>> TextHeader::numbers(const std::string& name) const {
  std::vector<double> values;
  std::istringstream words(field(name));
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value)) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

TextHeader readNrrdHeader(const std::filesystem::path& file) {
  Lines lines(file);
  TextHeader header;
  std::string line;
  if (!lines.next(line) || !line.starts_with("NRRD000"))
    throw BadInput(quoted(file) + " is no NRRD file, although its extension says so");
  while (lines.next(line)) {
    line = trimmed(line);
    if (line.empty()) break;  // the voxels follow
    if (line.front() == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    if (line.compare(colon, 2, ":=") == 0) {
      header.keys[line.substr(0, colon)] = line.substr(colon + 2);
      continue;
    }
    std::string name = lowerCase(line.substr(0, colon));
    if (name == "datafile") name = "data file";
    if (name == "lineskip") name = "line skip";
    if (name == "byteskip") name = "byte skip";
    if (!header.fields.emplace(name, trimmed(line.substr(colon + 1))).second)
      throw BadInput(quoted(file) + " gives '" + name.substr(0, 64) + "' twice in its header");
    if (name == "data file" && lowerCase(header.fields[name]).starts_with("list")) break;
  }
  header.bytes = lines.bytes();
  return header;
}

TextHeader readMetaHeader(const std::filesystem::path& file) {
  Lines lines(file);
  TextHeader header;
  std::string line;
  while (!header.fields.contains("ElementDataFile") && lines.next(line)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) break;
    header.fields[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  header.bytes = lines.bytes();
  return header;
}

std::filesystem::path voxelFile(const std::filesystem::path& header, const std::string& name) {
  const std::filesystem::path plain(name);
  const bool simple = !name.empty() && plain.filename() == plain && name != "." && name != ".." &&
                      name.find_first_of("/\\%") == std::string::npos;
  std::error_code failed;
  const std::filesystem::path path = header.parent_path() / plain;
  if (!simple || std::filesystem::symlink_status(path, failed).type() != std::filesystem::file_type::regular)
    throw BadInput(
        quoted(header) +
        " keeps its voxels in another file; only one file with a plain name, beside the header, is read: save "
        "the volume as one file (.nrrd, .mha)");
  return path;
}

}  // namespace glisson::image::detail
