// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/detail/nrrd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace glisson::image::detail {
namespace {

constexpr int mostAxes = 16;  // of the format's reference library
constexpr double maxDeflateRatio = 1040.0;

std::string quoted(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  throw BadInput(quoted(file) + " has a damaged NRRD header: " + what);
}

double bytesOfType(const std::string& name) {
  static const std::map<std::string, double> sizes = {{"signed char", 1},
                                                      {"int8", 1},
                                                      {"int8_t", 1},
                                                      {"uchar", 1},
                                                      {"unsigned char", 1},
                                                      {"uint8", 1},
                                                      {"uint8_t", 1},
                                                      {"short", 2},
                                                      {"short int", 2},
                                                      {"signed short", 2},
                                                      {"signed short int", 2},
                                                      {"int16", 2},
                                                      {"int16_t", 2},
                                                      {"ushort", 2},
                                                      {"unsigned short", 2},
                                                      {"unsigned short int", 2},
                                                      {"uint16", 2},
                                                      {"uint16_t", 2},
                                                      {"int", 4},
                                                      {"signed int", 4},
                                                      {"int32", 4},
                                                      {"int32_t", 4},
                                                      {"uint", 4},
                                                      {"unsigned int", 4},
                                                      {"uint32", 4},
                                                      {"uint32_t", 4},
                                                      {"longlong", 8},
                                                      {"long long", 8},
                                                      {"long long int", 8},
                                                      {"signed long long", 8},
                                                      {"signed long long int", 8},
                                                      {"int64", 8},
                                                      {"int64_t", 8},
                                                      {"ulonglong", 8},
                                                      {"unsigned long long", 8},
                                                      {"unsigned long long int", 8},
                                                      {"uint64", 8},
                                                      {"uint64_t", 8},
                                                      {"float", 4},
                                                      {"double", 8}};
  const auto known = sizes.find(name);
  return known == sizes.end() ? 0.0 : known->second;
}

/// Words of a per-axis field: vectors in parentheses, texts in quotes, else what stands between spaces.
std::vector<std::string> wordsOf(const std::string& field) {
  std::vector<std::string> words;
  for (std::size_t at = field.find_first_not_of(" \t"); at < field.size(); at = field.find_first_not_of(" \t", at)) {
    std::size_t end = field.find_first_of(" \t", at);
    if (field[at] == '(') end = std::min(field.find(')', at), field.size() - 1) + 1;
    if (field[at] == '"') end = std::min(field.find('"', at + 1), field.size() - 1) + 1;
    end = std::min(end, field.size());
    words.push_back(field.substr(at, end - at));
    at = end;
  }
  return words;
}

std::vector<double> checkedSizes(const TextHeader& h, const std::filesystem::path& file) {
  const auto dimension = h.numbers("dimension");
  if (!dimension || dimension->size() != 1 || (*dimension)[0] < 1 || (*dimension)[0] > mostAxes ||
      (*dimension)[0] != std::floor((*dimension)[0]))
    damaged(file, "its dimension is no whole number from 1 to 16");
  const auto axes = static_cast<std::size_t>((*dimension)[0]);
  const auto sizes = h.numbers("sizes");
  if (!sizes || sizes->size() != axes)
    damaged(file, "it gives no size for each of its " + std::to_string(axes) + " axes");
  for (const double n : *sizes)
    if (n < 1 || n > 2147483647.0 || n != std::floor(n)) damaged(file, "a size is no whole number from 1 on");
  for (const char* perAxis : {"spacings", "thicknesses", "axis mins", "axismins", "axis maxs", "axismaxs", "centers",
                              "centerings", "labels", "units", "kinds", "space directions"})
    if (h.fields.contains(perAxis) && wordsOf(h.field(perAxis)).size() != axes)
      damaged(file, std::string("its '") + perAxis + "' are not " + std::to_string(axes) + ", one for each axis");
  return *sizes;
}

void checkBytes(const TextHeader& h, const std::filesystem::path& file, const std::vector<double>& sizes) {
  const double perValue = bytesOfType(lowerCase(h.field("type")));
  if (perValue == 0.0) damaged(file, "it holds no values of a known type");
  double values = 1.0;
  for (const double n : sizes) values *= n;
  std::filesystem::path data = file;
  double begin = static_cast<double>(h.bytes);
  if (h.fields.contains("data file")) {
    data = voxelFile(file, h.field("data file"));
    begin = 0.0;
  }
  const auto there = static_cast<double>(std::filesystem::file_size(data));
  for (const char* skip : {"line skip", "byte skip"}) {
    const auto n = h.numbers(skip);
    if (!n || n->size() > 1) damaged(file, std::string("its '") + skip + "' is no number");
    if (n->empty()) continue;
    const bool fromEnd = std::string(skip) == "byte skip" && (*n)[0] == -1.0;
    if (!fromEnd && ((*n)[0] < 0 || (*n)[0] > there))
      damaged(file, std::string("its '") + skip + "' leads beyond the file");
  }
  const std::string encoding = lowerCase(h.field("encoding"));
  const bool raw = encoding == "raw",
             text = encoding == "ascii" || encoding == "text" || encoding == "txt" || encoding == "hex";
  if (!raw && !text && encoding != "gzip" && encoding != "gz")
    damaged(file, "its encoding is neither raw, gzip nor text");
  // Packed bytes inflate at most a thousandfold; a number written as text takes two characters at least.
  const double needed = raw    ? values * perValue
                        : text ? values * (encoding == "hex" ? 2.0 * perValue : 2.0) - 1.0
                               : values * perValue / maxDeflateRatio - 1024.0;
  if (needed > there - begin) {
    std::ostringstream why;
    why << quoted(file) << " is truncated or damaged: its header announces " << values << " values, but "
        << there - begin << " bytes of voxels are there; copy it again";
    throw BadInput(why.str());
  }
}

/// Segments that overlap are written as layers, one more axis in front: none of them is the image's.
void refuseLayers(const TextHeader& h, const std::filesystem::path& file, const std::vector<double>& sizes) {
  const std::vector<std::string> kinds = wordsOf(h.field("kinds"));
  if (!h.keys.contains("Segment0_ID") || sizes.size() != 4 || kinds.empty() || kinds.front() != "list") return;
  std::string names;
  for (int n = 0; h.keys.contains("Segment" + std::to_string(n) + "_ID") && n < 20; ++n) {
    const auto name = h.keys.find("Segment" + std::to_string(n) + "_Name");
    names +=
        (names.empty() ? "'" : ", '") + (name == h.keys.end() ? std::to_string(n) : name->second.substr(0, 40)) + "'";
  }
  std::ostringstream why;
  why << quoted(file) << " is a 3D Slicer segmentation whose segments overlap, in " << sizes.front() << " layers ("
      << names
      << "): which voxels are the region's is not said by a label. In 3D Slicer, export the one segment as a labelmap "
         "(Segmentations, Export), or save the segmentation as DICOM; then give that file";
  throw BadInput(why.str());
}

/// Millimetres in a unit of length; 0 where it is not known.
double millimetresIn(const std::string& quotedUnit) {
  std::string unit = quotedUnit;
  std::erase(unit, '"');
  static const std::map<std::string, double> known = {
      {"", 1.0},           {"mm", 1.0},         {"millimeter", 1.0}, {"millimeters", 1.0}, {"millimetre", 1.0},
      {"cm", 10.0},        {"centimeter", 10},  {"centimeters", 10}, {"m", 1000.0},        {"meter", 1000.0},
      {"meters", 1000.0},  {"um", 1e-3},        {"micron", 1e-3},    {"microns", 1e-3},    {"micrometer", 1e-3},
      {"\xC2\xB5m", 1e-3}, {"\xCE\xBCm", 1e-3}, {"???", 1.0}};
  const auto found = known.find(lowerCase(unit));
  return found == known.end() ? 0.0 : found->second;
}

}  // namespace

TextHeader checkedNrrd(const std::filesystem::path& file) {
  TextHeader h = readNrrdHeader(file);
  const std::vector<double> sizes = checkedSizes(h, file);
  checkBytes(h, file, sizes);
  refuseLayers(h, file, sizes);
  if (h.fields.contains("space") && !h.fields.contains("space directions"))
    throw BadInput(quoted(file) + " names a space ('" + h.field("space").substr(0, 40) +
                   "') but no 'space directions', so how its axes lie in it is not said" +
                   (h.fields.contains("spacings")
                        ? " (its 'spacings' " + h.field("spacings").substr(0, 60) + " have no direction)"
                        : std::string()) +
                   "; write the directions into its header, or save it again from the program that made it");
  return h;
}

void completeNrrd(const TextHeader& h, const std::filesystem::path& file, Grid& grid, Diagnostics* doubts) {
  const bool placed = h.fields.contains("space directions");
  const std::vector<std::string> units = wordsOf(h.field(placed ? "space units" : "units"));
  std::array<double, 3> mm{1.0, 1.0, 1.0};
  const std::size_t first = units.size() > 3 && !placed ? units.size() - 3 : 0;
  for (std::size_t a = 0; a < 3 && first + a < units.size(); ++a) {
    mm[a] = millimetresIn(units[first + a]);
    if (mm[a] == 0.0)
      throw BadInput(quoted(file) + " gives lengths in " + units[first + a].substr(0, 20) +
                     ", which is no unit of length that is known here; save it in millimetres");
  }
  if (mm[0] != mm[1] || mm[1] != mm[2])
    throw BadInput(quoted(file) + " gives lengths in different units along its axes; save it in millimetres");
  grid.spacing_mm *= mm[0];
  grid.origin_lps_mm *= mm[0];
  if (doubts == nullptr) return;
  const std::string space = lowerCase(h.field("space"));
  const bool patient = space.find("left") != std::string::npos || space.find("right-a") != std::string::npos ||
                       space.find("right-p") != std::string::npos || space == "ras" || space == "las" ||
                       space == "lps" || space == "rast" || space == "last" || space == "lpst";
  const bool handed = space.find("handed") != std::string::npos;
  if (!placed || !patient || handed)
    doubts->add(DiagnosticCode::VolumePlaceUnknown, {{"missing", std::string("space of the patient")}});
  else if (!h.fields.contains("space origin"))
    doubts->add(DiagnosticCode::VolumePlaceUnknown, {{"missing", std::string("space origin")}});
}

}  // namespace glisson::image::detail
