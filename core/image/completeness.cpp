#include "image/completeness.h"

#include <zlib.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cctype>
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

/// ITK falls back silently to the qform where the sform holds shear.
void refuseShear(const NiftiHeader& header, const std::filesystem::path& file) {
  if (header.number16(254) <= 0) return;  // no sform
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
  refuseShear(header, file);
  double needed = header.number16(72) / 8.0;
  const int dimensions = header.number16(40);
  if (dimensions < 1 || dimensions > 7 || needed <= 0.0)
    throw BadInput(quoted(file) + " has a damaged NIfTI header (" + std::to_string(dimensions) + " dimensions)");
  for (int d = 1; d <= dimensions; ++d) needed *= header.number16(40 + 2 * static_cast<std::size_t>(d));
  needed += std::max(header.real(108), 0.0);  // voxels begin at vox_offset
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

}  // namespace glisson::image
