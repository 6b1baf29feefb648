// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/detail/completeness.h"

#include <zlib.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "image/detail/text_header.h"

namespace glisson::image {
namespace {

constexpr std::size_t blockSize = 1U << 20;

std::string quoted(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

[[noreturn]] void truncated(const std::filesystem::path& file, double needed, double there) {
  std::ostringstream why;
  why << quoted(file) << " is truncated or damaged: its header announces " << needed << " bytes, " << there
      << " are there; copy it again";
  throw BadInput(why.str());
}

double bytesOfMetaType(const std::string& type) {
  static const std::map<std::string, double> sizes = {{"MET_CHAR", 1},       {"MET_UCHAR", 1}, {"MET_SHORT", 2},
                                                      {"MET_USHORT", 2},     {"MET_INT", 4},   {"MET_UINT", 4},
                                                      {"MET_LONG", 4},       {"MET_ULONG", 4}, {"MET_LONG_LONG", 8},
                                                      {"MET_ULONG_LONG", 8}, {"MET_FLOAT", 4}, {"MET_DOUBLE", 8}};
  const auto known = sizes.find(type);
  return known == sizes.end() ? 0.0 : known->second;
}

/// How many bytes a zlib or gzip stream inflates to; stops at limit.
double inflatedSize(std::istream& in, double limit) {
  std::vector<char> packed(blockSize);
  std::vector<char> plain(blockSize);
  z_stream z{};
  if (inflateInit2(&z, MAX_WBITS + 32) != Z_OK) return 0.0;
  double total = 0.0;
  int state = Z_OK;
  while (state == Z_OK && total < limit) {
    if (z.avail_in == 0) {
      in.read(packed.data(), static_cast<std::streamsize>(packed.size()));
      if (in.gcount() <= 0) break;
      z.next_in = reinterpret_cast<Bytef*>(packed.data());
      z.avail_in = static_cast<uInt>(in.gcount());
    }
    z.next_out = reinterpret_cast<Bytef*>(plain.data());
    z.avail_out = static_cast<uInt>(plain.size());
    state = inflate(&z, Z_NO_FLUSH);
    total += static_cast<double>(plain.size() - z.avail_out);
  }
  inflateEnd(&z);
  return total;
}

}  // namespace

namespace {

/// Fields with one number for each axis, and with one for each pair of them: the library reads as many as it is told.
void checkLists(const detail::TextHeader& h, const std::filesystem::path& file, std::size_t axes) {
  const auto wrong = [&](const char* name, std::size_t expected) {
    const auto numbers = h.numbers(name);
    if (h.fields.contains(name) && (!numbers || numbers->size() != expected))
      throw BadInput(quoted(file) + " has a damaged MetaImage header: " + name + " is not " + std::to_string(expected) +
                     " numbers");
  };
  for (const char* name :
       {"DimSize", "Offset", "Position", "Origin", "CenterOfRotation", "ElementSpacing", "ElementSize"})
    wrong(name, axes);
  for (const char* name : {"TransformMatrix", "Rotation", "Orientation"}) wrong(name, axes * axes);
}

}  // namespace

void completeMetaImage(const std::filesystem::path& file, Grid& grid, Diagnostics* doubts) {
  const detail::TextHeader h = detail::readMetaHeader(file);
  static const std::map<std::string, double> units = {{"", 1.0},    {"?", 1.0},   {"mm", 1.0},
                                                      {"um", 1e-3}, {"cm", 10.0}, {"m", 1e3}};
  const auto unit = units.find(lowerCase(h.field("DistanceUnits")));
  if (unit == units.end())
    throw BadInput(quoted(file) + " gives lengths in '" + h.field("DistanceUnits").substr(0, 20) +
                   "', which is no unit of length that is known here; save it in millimetres");
  grid.spacing_mm *= unit->second;
  grid.origin_lps_mm *= unit->second;
  const auto slope = h.numbers("ElementToIntensityFunctionSlope"),
             offset = h.numbers("ElementToIntensityFunctionOffset");
  const auto is = [](const auto& n, double plain) { return n && (n->empty() || (n->size() == 1 && (*n)[0] == plain)); };
  if (!is(slope, 1.0) || !is(offset, 0.0))
    throw BadInput(quoted(file) +
                   " scales its values in its header (ElementToIntensityFunctionSlope or Offset), which is "
                   "read by few programs and not here; save it with the values themselves");
  if (doubts == nullptr) return;
  if (!h.fields.contains("ElementSpacing") && !h.fields.contains("ElementSize"))
    doubts->add(DiagnosticCode::VolumePlaceUnknown, {{"missing", std::string("ElementSpacing")}});
  // A letter for the side from which each axis comes; ITK's axes, to the patient's left, back and head, are RAI.
  std::string taken;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Eigen::Index most = 0;
    grid.direction.col(axis).cwiseAbs().maxCoeff(&most);
    taken += (grid.direction(most, axis) > 0 ? "RAI" : "LPS")[most];
  }
  const std::string said = h.field("AnatomicalOrientation");
  const bool known = said.size() == 3 && said.find_first_not_of("RLAPIS") == std::string::npos;
  if (known && said != taken) doubts->add(DiagnosticCode::AxesContradicted, {{"said", said}, {"taken", taken}});
}

void doubtVoxelSize(const Grid& grid, Diagnostics* doubts) {
  constexpr double least_mm = 0.02, most_mm = 200.0;
  const double smallest = grid.spacing_mm.minCoeff(), largest = grid.spacing_mm.maxCoeff();
  if (doubts == nullptr || (smallest >= least_mm && largest <= most_mm)) return;
  doubts->add(DiagnosticCode::VoxelSizeOdd, {{"smallest_mm", smallest}, {"largest_mm", largest}});
}

void checkMetaImage(const std::filesystem::path& file, Diagnostics* doubts) {
  const detail::TextHeader h = detail::readMetaHeader(file);
  const auto damaged = [&file](const std::string& what) {
    throw BadInput(quoted(file) + " has a damaged MetaImage header: " + what);
  };
  constexpr std::size_t longestName = 200, longestValue = 4000;
  for (const auto& [name, value] : h.fields)
    if (name.size() > longestName || value.size() > longestValue) damaged("a line of it is too long");
  const auto axes = h.numbers("NDims"), sizes = h.numbers("DimSize");
  double needed = bytesOfMetaType(h.field("ElementType"));
  if (h.field("ElementDataFile").empty() || h.field("DimSize").empty() || needed <= 0.0)
    throw BadInput(quoted(file) + " is no MetaImage with a readable header");
  if (!axes || axes->size() != 1 || (*axes)[0] < 1 || (*axes)[0] > 4 || (*axes)[0] != std::floor((*axes)[0]))
    damaged("NDims is no whole number from 1 to 4");
  checkLists(h, file, static_cast<std::size_t>((*axes)[0]));
  for (const double n : *sizes) {
    if (n < 1 || n > 2147483647.0 || n != std::floor(n)) damaged("DimSize holds no whole numbers from 1 on");
    needed *= n;
  }
  if (h.fields.contains("ElementNumberOfChannels")) {
    const auto channels = h.numbers("ElementNumberOfChannels");
    if (!channels || channels->size() != 1 || (*channels)[0] < 1 || (*channels)[0] > 256)
      damaged("ElementNumberOfChannels is no number from 1 to 256");
    needed *= (*channels)[0];
  }
  const bool local = lowerCase(h.field("ElementDataFile")) == "local";
  const std::filesystem::path data = local ? file : detail::voxelFile(file, h.field("ElementDataFile"));
  const auto bytes = static_cast<double>(std::filesystem::file_size(data));
  const auto skip = h.numbers("HeaderSize");
  if (!skip || skip->size() > 1 || (!skip->empty() && ((*skip)[0] < -1 || (*skip)[0] > bytes)))
    damaged("HeaderSize leads beyond the file");
  std::ifstream in(data, std::ios::binary);
  if (local) in.seekg(static_cast<std::streamoff>(h.bytes));
  const double there = lowerCase(h.field("CompressedData")) == "true"
                           ? inflatedSize(in, needed)
                           : bytes - (local ? static_cast<double>(h.bytes) : 0.0);
  if (there < needed) truncated(file, needed, there);
  if (doubts != nullptr && !h.fields.contains("Offset") && !h.fields.contains("Position") &&
      !h.fields.contains("Origin"))
    doubts->add(DiagnosticCode::VolumePlaceUnknown, {{"missing", std::string("Offset")}});
}

}  // namespace glisson::image
