// SPDX-License-Identifier: GPL-3.0-or-later

// What a legacy VTK file announces, against what it can hold: VTK's reader believes every count.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/detail/surface_formats.h"

namespace glisson::anatomy::detail {
namespace {

constexpr std::size_t longestHeaderLine = 255, longestLine = 1U << 20;

bool among(const std::string& word, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&word](const char* w) { return word == w; });
}

bool isType(const std::string& word) {
  return among(word, {"bit", "unsigned_char", "char", "unsigned_short", "short", "unsigned_int", "int", "unsigned_long",
                      "long", "vtktypeint64", "vtktypeuint64", "vtkIdType", "float", "double", "string", "variant"});
}

/// A line without its end; of a longer one the beginning, so that binary parts cost no memory.
bool nextLine(std::istream& in, std::string& line) {
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (c == '\n') return true;
    if (line.size() < longestLine) line.push_back(static_cast<char>(c));
  }
  return !line.empty();
}

/// The whole numbers among the words of a line, as doubles; -1 for a negative one.
std::vector<double> countsIn(const std::vector<std::string>& words) {
  std::vector<double> counts;
  for (std::size_t w = 1; w < words.size(); ++w) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(words[w].data(), words[w].data() + words[w].size(), value);
    if (error == std::errc() && end == words[w].data() + words[w].size()) counts.push_back(value < 0.0 ? -1.0 : value);
  }
  return counts;
}

/// The next whole number of a list: text, or four bytes, the highest first. False where there is none.
bool nextNumber(std::istream& in, bool binary, double& value) {
  if (!binary) return static_cast<bool>(in >> value);
  std::array<char, 4> b{};
  if (!in.read(b.data(), b.size())) return false;
  std::uint32_t bits = 0;
  for (const char c : b) bits = bits << 8U | static_cast<unsigned char>(c);
  value = static_cast<double>(static_cast<std::int32_t>(bits));
  return true;
}

/// Reads a list of cells (before version 5: each with the number of its points first), which VTK's reader follows
/// wherever it leads.
void checkCellList(const std::filesystem::path& path, std::istream& in, bool binary, double cells, double numbers) {
  double read = 0.0, value = 0.0;
  const auto next = [&] {
    if (!nextNumber(in, binary, value) || value < 0.0 || value != std::floor(value))
      refuseSurface(path, "its list of cells is cut off, or holds no whole numbers");
    return ++read <= numbers;
  };
  for (double cell = 0.0; cell < cells; cell += 1.0) {
    bool fits = next();
    const double points = value;
    for (double p = 0.0; fits && p < points; p += 1.0) fits = next();
    if (!fits) refuseSurface(path, "its list of cells contradicts itself");
  }
  if (read != numbers) refuseSurface(path, "its list of cells contradicts itself");
}

/// The same from version 5 on: the two arrays that follow have to be there in full; VTK's reader goes on where they
/// end.
void checkCellArrays(const std::filesystem::path& path, std::istream& in, bool binary, double offsets, double ids) {
  for (const auto& [name, count] : {std::pair<std::string, double>("OFFSETS", offsets), {"CONNECTIVITY", ids}}) {
    std::string line;
    while (nextLine(in, line) && line.find_first_not_of(" \t\r") == std::string::npos) {
    }
    bool there = line.starts_with(name);
    const std::streamoff each = line.find("int64") != std::string::npos ? 8 : 4;
    if (binary) {
      in.ignore(static_cast<std::streamoff>(count) * each);
      there = there && in.gcount() == static_cast<std::streamoff>(count) * each;
    }
    double value = 0.0;
    for (double n = 0.0; there && !binary && n < count; n += 1.0) there = nextNumber(in, false, value);
    if (!there) refuseSurface(path, "its list of cells is cut off, or holds no whole numbers");
  }
}

/// A word that a section begins with.
bool isSection(const std::string& word) {
  return among(word, {"POINTS",
                      "VERTICES",
                      "LINES",
                      "POLYGONS",
                      "TRIANGLE_STRIPS",
                      "CELLS",
                      "CELL_TYPES",
                      "POINT_DATA",
                      "CELL_DATA",
                      "FIELD",
                      "SCALARS",
                      "COLOR_SCALARS",
                      "LOOKUP_TABLE",
                      "VECTORS",
                      "NORMALS",
                      "TENSORS",
                      "TEXTURE_COORDINATES",
                      "INFORMATION",
                      "OFFSETS",
                      "CONNECTIVITY",
                      "DIMENSIONS",
                      "GLOBAL_IDS",
                      "PEDIGREE_IDS",
                      "EDGE_FLAGS"});
}

/// Goes through a file line by line; every section must fit into it.
class LegacyVtk {
 public:
  explicit LegacyVtk(const std::filesystem::path& path)
      : path_(path), bytes_(static_cast<double>(std::filesystem::file_size(path))), in_(path, std::ios::binary) {}

  void check() {
    checkHeader();
    std::string line;
    while (nextLine(in_, line))
      if (line.size() <= longestHeaderLine) checkLine(line);  // longer ones are values, not words
    if (!dataset_) refuseSurface(path_, "it holds neither polygons nor cells");
  }

 private:
  void checkHeader();
  void checkLine(const std::string& line);
  void checkCounts(const std::vector<std::string>& words, const std::vector<double>& counts, bool array) const;
  void checkPoints(const std::vector<std::string>& words, const std::vector<double>& counts);
  void checkCells(const std::string& section, const std::vector<double>& counts);

  const std::filesystem::path& path_;
  double bytes_;
  std::ifstream in_;
  bool listsOfOldKind_ = false;  ///< before version 5
  bool binary_ = false;
  bool dataset_ = false;
};

void LegacyVtk::checkHeader() {
  std::string line;
  const std::string title = "# vtk DataFile Version";
  if (!nextLine(in_, line) || !line.starts_with(title))
    refuseSurface(path_, "it is no legacy VTK file, although its extension says so");
  listsOfOldKind_ = std::atof(line.c_str() + title.size()) < 5.0;
  for (int n = 0; n < 2; ++n)
    if (!nextLine(in_, line) || line.size() > longestHeaderLine)
      refuseSurface(path_, "a line of its header is missing or longer than 255 characters");
  binary_ = line.starts_with("BINARY") || line.starts_with("binary");
}

void LegacyVtk::checkCounts(const std::vector<std::string>& words, const std::vector<double>& counts,
                            bool array) const {
  // One value takes a byte at least (a bit in binary files takes none: they are surfaces' neither).
  double product = 1.0;
  for (const double c : counts) {
    if (c < 0.0 || c > bytes_)
      refuseSurface(path_, "it announces more " + words.front().substr(0, 30) + " than it can hold");
    product *= std::max(c, 1.0);
  }
  if (array && product > bytes_) refuseSurface(path_, "it announces an array larger than the file");
}

void LegacyVtk::checkPoints(const std::vector<std::string>& words, const std::vector<double>& counts) {
  if (counts.empty()) return;
  if (3.0 * counts.front() > bytes_) refuseSurface(path_, "it announces more POINTS than it can hold");
  if (binary_ && words.size() > 2 && among(words[2], {"float", "double"}))
    in_.seekg(static_cast<std::streamoff>(3.0 * counts.front()) * (words[2] == "float" ? 4 : 8), std::ios::cur);
}

void LegacyVtk::checkCells(const std::string& section, const std::vector<double>& counts) {
  if (counts.size() != 2) refuseSurface(path_, "its " + section + " do not say how many they are");
  if (listsOfOldKind_)
    checkCellList(path_, in_, binary_, counts[0], counts[1]);
  else if (counts[0] > 0.0)
    checkCellArrays(path_, in_, binary_, counts[0], counts[1]);
}

void LegacyVtk::checkLine(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; words.size() < 8 && stream >> word;) words.push_back(word);
  if (words.empty()) return;
  const std::string& first = words.front();
  if (first == "DATASET") {
    dataset_ = true;
    if (words.size() < 2 || !among(words[1], {"POLYDATA", "UNSTRUCTURED_GRID"}))
      refuseSurface(path_, "it holds neither polygons nor cells");
    return;
  }
  const bool array = words.size() == 4 && isType(words[3]);
  if (!isSection(first) && !array) return;
  const std::vector<double> counts = countsIn(words);
  checkCounts(words, counts, array);
  if (first == "POINTS") checkPoints(words, counts);
  if (among(first, {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS"})) checkCells(first, counts);
}

}  // namespace

void checkLegacyVtk(const std::filesystem::path& path) {
  LegacyVtk(path).check();
}

}  // namespace glisson::anatomy::detail
