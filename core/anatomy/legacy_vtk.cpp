// What a legacy VTK file announces, against what it can hold: VTK's reader believes every count.
#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
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

}  // namespace

void checkLegacyVtk(const std::filesystem::path& path) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  std::ifstream in(path, std::ios::binary);
  std::string line;
  if (!nextLine(in, line) || !line.starts_with("# vtk DataFile Version"))
    refuseSurface(path, "it is no legacy VTK file, although its extension says so");
  for (int n = 0; n < 2; ++n)
    if (!nextLine(in, line) || line.size() > longestHeaderLine)
      refuseSurface(path, "a line of its header is missing or longer than 255 characters");
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
  }
  if (!dataset) refuseSurface(path, "it holds neither polygons nor cells");
}

}  // namespace glisson::anatomy::detail
