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

/// The same from version 5 on: the two arrays that follow have to be there in full; VTK's reader goes on where they end.
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

}  // namespace

void checkLegacyVtk(const std::filesystem::path& path) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  std::ifstream in(path, std::ios::binary);
  std::string line;
  const std::string title = "# vtk DataFile Version";
  if (!nextLine(in, line) || !line.starts_with(title))
    refuseSurface(path, "it is no legacy VTK file, although its extension says so");
  const bool listsOfOldKind = std::atof(line.c_str() + title.size()) < 5.0;
  for (int n = 0; n < 2; ++n)
    if (!nextLine(in, line) || line.size() > longestHeaderLine)
      refuseSurface(path, "a line of its header is missing or longer than 255 characters");
  const bool binary = line.starts_with("BINARY") || line.starts_with("binary");
  bool dataset = false;
  while (nextLine(in, line)) {
    if (line.size() > longestHeaderLine) continue;  // values, not words
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; words.size() < 8 && stream >> word;) words.push_back(word);
    if (words.empty()) continue;
    const std::string& first = words.front();
    if (first == "DATASET") {
      dataset = true;
      if (words.size() < 2 || !among(words[1], {"POLYDATA", "UNSTRUCTURED_GRID"}))
        refuseSurface(path, "it holds neither polygons nor cells");
      continue;
    }
    const bool section = among(first, {"POINTS", "VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS", "CELL_TYPES",
                                       "POINT_DATA", "CELL_DATA", "FIELD", "SCALARS", "COLOR_SCALARS", "LOOKUP_TABLE",
                                       "VECTORS", "NORMALS", "TENSORS", "TEXTURE_COORDINATES", "INFORMATION", "OFFSETS",
                                       "CONNECTIVITY", "DIMENSIONS", "GLOBAL_IDS", "PEDIGREE_IDS", "EDGE_FLAGS"});
    const bool array = words.size() == 4 && isType(words[3]);
    if (!section && !array) continue;
    // One value takes a byte at least (a bit in binary files takes none: they are surfaces' neither).
    const std::vector<double> counts = countsIn(words);
    double product = 1.0;
    for (const double c : counts) {
      if (c < 0.0 || c > bytes) refuseSurface(path, "it announces more " + first.substr(0, 30) + " than it can hold");
      product *= std::max(c, 1.0);
    }
    if (array && product > bytes) refuseSurface(path, "it announces an array larger than the file");
    if (first == "POINTS" && !counts.empty() && 3.0 * counts.front() > bytes)
      refuseSurface(path, "it announces more POINTS than it can hold");
    if (first == "POINTS" && binary && !counts.empty() && words.size() > 2 && among(words[2], {"float", "double"}))
      in.seekg(static_cast<std::streamoff>(3.0 * counts.front()) * (words[2] == "float" ? 4 : 8), std::ios::cur);
    if (among(first, {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS"})) {
      if (counts.size() != 2) refuseSurface(path, "its " + first + " do not say how many they are");
      if (listsOfOldKind)
        checkCellList(path, in, binary, counts[0], counts[1]);
      else if (counts[0] > 0.0)
        checkCellArrays(path, in, binary, counts[0], counts[1]);
    }
  }
  if (!dataset) refuseSurface(path, "it holds neither polygons nor cells");
}

}  // namespace glisson::anatomy::detail
