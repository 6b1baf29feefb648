#include "image/completeness.h"

#include <zlib.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"

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

class GzFile {
 public:
  explicit GzFile(const std::filesystem::path& file) : handle_(gzopen(file.c_str(), "rb")) {
    if (handle_ == nullptr) throw BadInput(quoted(file) + " cannot be opened");
  }
  ~GzFile() { gzclose(handle_); }
  GzFile(const GzFile&) = delete;
  GzFile& operator=(const GzFile&) = delete;
  /// Bytes read; fewer than asked for at the end or where the data are damaged.
  std::size_t read(void* to, std::size_t count) {
    const int got = gzread(handle_, to, static_cast<unsigned>(count));
    return got < 0 ? 0 : static_cast<std::size_t>(got);
  }

 private:
  gzFile handle_;
};

class NiftiHeader {
 public:
  NiftiHeader(const std::array<unsigned char, 348>& bytes, bool big) : bytes_(bytes), big_(big) {}
  int number16(std::size_t at) const {
    return static_cast<std::int16_t>(big_ ? (bytes_[at] << 8) | bytes_[at + 1] : (bytes_[at + 1] << 8) | bytes_[at]);
  }
  double real(std::size_t at) const {
    std::array<unsigned char, 4> b{bytes_[at], bytes_[at + 1], bytes_[at + 2], bytes_[at + 3]};
    if (big_) std::reverse(b.begin(), b.end());
    float value = 0.0F;
    std::memcpy(&value, b.data(), 4);
    return static_cast<double>(value);
  }

 private:
  const std::array<unsigned char, 348>& bytes_;
  bool big_;
};

/// Bytes of a value of a NIfTI datatype; 0 where it is none.
double bytesOfNiftiType(int type) {
  static const std::map<int, double> sizes = {{2, 1},     {4, 2},     {8, 4},     {16, 4},  {32, 8},   {64, 8},
                                              {128, 3},   {256, 1},   {512, 2},   {768, 4}, {1024, 8}, {1280, 8},
                                              {1536, 16}, {1792, 16}, {2048, 32}, {2304, 4}};
  const auto known = sizes.find(type);
  return known == sizes.end() ? 0.0 : known->second;
}

/// ITK falls back silently to the qform where the sform holds shear, and to no orientation where numbers are missing.
void refuseBadAxes(const NiftiHeader& header, const std::filesystem::path& file) {
  if (header.number16(254) <= 0) {  // no sform
    if (header.number16(252) <= 0) return;
    for (std::size_t at = 256; at < 280; at += 4)
      if (!std::isfinite(header.real(at)))
        throw BadInput(quoted(file) + ": the NIfTI qform is not finite; no voxel position follows from it");
    return;
  }
  Eigen::Matrix3d axes;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      axes(row, column) = header.real(280 + static_cast<std::size_t>(16 * row + 4 * column));
  const Eigen::Vector3d lengths = axes.colwise().norm();
  if (!axes.allFinite() || lengths.minCoeff() <= 0.0)
    throw BadInput(quoted(file) + ": the NIfTI sform is singular or not finite; no voxel position follows from it");
  axes = axes * lengths.cwiseInverse().asDiagonal();
  const double shear = (axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (shear <= 1e-4) return;
  std::ostringstream why;
  why << quoted(file) << ": the NIfTI sform is sheared (axes off a right angle by " << shear
      << " rad); resample the image to a regular grid";
  throw BadInput(why.str());
}

std::string lower(std::string s) {
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
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

void checkNifti(const std::filesystem::path& file) {
  GzFile in(file);
  std::array<unsigned char, 348> bytes{};
  if (in.read(bytes.data(), bytes.size()) != bytes.size())
    throw BadInput(quoted(file) + " is shorter than a NIfTI header (348 bytes); it is truncated or another format");
  const bool little = bytes[0] == 0x5c && bytes[1] == 0x01;
  const bool big = bytes[2] == 0x01 && bytes[3] == 0x5c;
  if (!little && !big) throw BadInput(quoted(file) + " is not a NIfTI-1 file, although its extension says so");
  const NiftiHeader header(bytes, big);
  // Without the last byte's "n+1" these are Analyze files or header and voxels apart: no orientation, or other voxels.
  if (std::memcmp(bytes.data() + 344, "n+1", 4) != 0)
    throw BadInput(quoted(file) +
                   " is no NIfTI-1 file of one piece (an Analyze file, or a header whose voxels are in another file); "
                   "save it as .nii or .nii.gz");
  refuseBadAxes(header, file);
  double needed = bytesOfNiftiType(header.number16(70));
  if (needed <= 0.0)
    throw BadInput(quoted(file) + " has a damaged NIfTI header (datatype " + std::to_string(header.number16(70)) + ")");
  const int dimensions = header.number16(40);
  if (dimensions < 1 || dimensions > 7)
    throw BadInput(quoted(file) + " has a damaged NIfTI header (" + std::to_string(dimensions) + " dimensions)");
  for (int d = 1; d <= dimensions; ++d) {
    const int extent = header.number16(40 + 2 * static_cast<std::size_t>(d));
    if (extent < 1)
      throw BadInput(quoted(file) + " has a damaged NIfTI header (" + std::to_string(extent) + " voxels along axis " +
                     std::to_string(d) + ")");
    needed *= extent;
  }
  // Voxels read from another place than they are written to would be shifted and look like an image.
  const double begin = header.real(108);
  if (!(begin >= 352.0) || begin != std::floor(begin)) {
    std::ostringstream why;
    why << quoted(file) << " has a damaged NIfTI header: its voxels are said to begin at byte " << begin
        << ", within the header of 352 bytes";
    throw BadInput(why.str());
  }
  needed += begin;
  double there = 348.0;
  std::vector<char> block(blockSize);
  while (there < needed) {
    const std::size_t got = in.read(block.data(), block.size());
    if (got == 0) truncated(file, needed, there);
    there += static_cast<double>(got);
  }
}

void checkMetaImage(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadInput(quoted(file) + " cannot be opened");
  std::map<std::string, std::string> fields;
  std::string line;
  while (fields.size() < 200 && line.size() < 4096 && !fields.contains("ElementDataFile") && std::getline(in, line)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) break;
    const auto trimmed = [](const std::string& s) {
      const std::size_t first = s.find_first_not_of(" \t\r");
      return first == std::string::npos ? std::string() : s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
    };
    fields[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
  }
  double needed = bytesOfMetaType(fields["ElementType"]);
  std::istringstream sizes(fields["DimSize"]);
  for (double n = 0.0; sizes >> n;) needed *= n;
  if (fields["ElementDataFile"].empty() || fields["DimSize"].empty() || needed <= 0.0)
    throw BadInput(quoted(file) + " is no MetaImage with a readable header");
  if (fields.contains("ElementNumberOfChannels")) {
    double channels = 1.0;
    std::istringstream(fields["ElementNumberOfChannels"]) >> channels;
    needed *= channels;
  }
  std::ifstream detached;
  const bool local = lower(fields["ElementDataFile"]) == "local";
  if (!local) {
    detached.open(file.parent_path() / fields["ElementDataFile"], std::ios::binary);
    if (!detached) throw BadInput(quoted(file) + " keeps its voxels in another file, which is not there as one file");
  }
  std::istream& data = local ? in : detached;
  double there = 0.0;
  if (lower(fields["CompressedData"]) == "true") {
    there = inflatedSize(data, needed);
  } else {
    const auto begin = data.tellg();
    data.seekg(0, std::ios::end);
    there = static_cast<double>(data.tellg() - begin);
  }
  if (there < needed) truncated(file, needed, there);
}

void checkNrrd(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadInput(quoted(file) + " cannot be opened");
  std::string line;
  for (int n = 0; n < 1000 && std::getline(in, line) && line.size() < 4096; ++n) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty()) return;  // the voxels follow in this file
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string field = lower(line.substr(0, colon));
    if (field != "data file" && field != "datafile") continue;
    const std::size_t first = line.find_first_not_of(" \t", colon + 1);
    const std::string name = first == std::string::npos ? std::string() : line.substr(first);
    std::error_code failed;
    if (!std::filesystem::is_regular_file(file.parent_path() / name, failed))
      throw BadInput(quoted(file) + " keeps its voxels in another file, which is not there as one file");
    return;
  }
}

}  // namespace glisson::image
