#include "image/completeness.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"

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
  const bool local = lowerCase(fields["ElementDataFile"]) == "local";
  if (!local) {
    detached.open(file.parent_path() / fields["ElementDataFile"], std::ios::binary);
    if (!detached) throw BadInput(quoted(file) + " keeps its voxels in another file, which is not there as one file");
  }
  std::istream& data = local ? in : detached;
  double there = 0.0;
  if (lowerCase(fields["CompressedData"]) == "true") {
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
    const std::string field = lowerCase(line.substr(0, colon));
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
