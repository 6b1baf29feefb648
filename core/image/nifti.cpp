// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/detail/nifti.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "base/error.h"

namespace glisson::image::detail {
namespace {

constexpr std::size_t headerBytes = 348, leastVoxelOffset = 352, blockSize = 1U << 20;
/// Deflate cannot shrink more than 1032:1, so a file that promises more than this holds less than it says.
constexpr double maxDeflateRatio = 1040.0;

std::string quoted(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  throw BadInput(quoted(file) + " has a damaged NIfTI header: " + what);
}

[[noreturn]] void truncated(const std::filesystem::path& file, double needed, double there) {
  std::ostringstream why;
  why << quoted(file) << " is truncated or damaged: its header announces " << needed << " bytes, " << there
      << " are there; copy it again";
  throw BadInput(why.str());
}

/// Plain or gzip-compressed, whatever its name says.
class GzFile {
 public:
  explicit GzFile(const std::filesystem::path& file) : handle_(gzopen(file.c_str(), "rb")) {
    if (handle_ == nullptr) throw BadInput(quoted(file) + " cannot be opened");
  }
  ~GzFile() { gzclose(handle_); }
  GzFile(const GzFile&) = delete;
  GzFile& operator=(const GzFile&) = delete;
  /// Bytes read; fewer than asked for at the end or where the data are damaged.
  std::size_t read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
      const int got = gzread(handle_, to + done, static_cast<unsigned>(std::min(count - done, blockSize)));
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

 private:
  gzFile handle_;
};

class Header {
 public:
  Header(GzFile& in, const std::filesystem::path& file) : file_(file) {
    if (in.read(bytes_.data(), headerBytes) != headerBytes)
      throw BadInput(quoted(file) + " is shorter than a NIfTI header (348 bytes); it is truncated or another format");
    const bool little = bytes_[0] == 0x5c && bytes_[1] == 0x01;
    big_ = bytes_[2] == 0x01 && bytes_[3] == 0x5c;
    if (!little && !big_) throw BadInput(quoted(file) + " is not a NIfTI-1 file, although its extension says so");
    // Without "n+1" these are Analyze files or header and voxels apart: no orientation, or other voxels.
    if (std::memcmp(bytes_.data() + 344, "n+1", 4) != 0)
      throw BadInput(quoted(file) +
                     " is no NIfTI-1 file of one piece (an Analyze file, or a header whose voxels are in another "
                     "file); save it as .nii or .nii.gz");
  }
  bool big() const { return big_; }
  int byte(std::size_t at) const { return static_cast<unsigned char>(bytes_[at]); }
  int number16(std::size_t at) const {
    return static_cast<std::int16_t>(big_ ? (byte(at) << 8) | byte(at + 1) : (byte(at + 1) << 8) | byte(at));
  }
  double real(std::size_t at) const {
    std::array<char, 4> b{bytes_[at], bytes_[at + 1], bytes_[at + 2], bytes_[at + 3]};
    if (big_) std::reverse(b.begin(), b.end());
    float value = 0.0F;
    std::memcpy(&value, b.data(), 4);
    return static_cast<double>(value);
  }
  int extent(int axis) const { return number16(40 + 2 * static_cast<std::size_t>(axis)); }
  double step(int axis) const { return real(76 + 4 * static_cast<std::size_t>(axis)); }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::array<char, headerBytes> bytes_{};
  bool big_ = false;
};

using Affine = Eigen::Matrix<double, 3, 4>;

Affine sform(const Header& h) {
  Affine a;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      a(row, column) = h.real(280 + static_cast<std::size_t>(16 * row + 4 * column));
  return a;
}

/// Steps of pixdim along the axes of the quaternion, or along the patient's where there is none.
Affine ofSteps(const Header& h, bool quaternion) {
  Eigen::Vector3d step;
  for (int axis = 0; axis < 3; ++axis) step[axis] = h.step(axis + 1);
  if (!(step.allFinite() && step.minCoeff() > 0.0)) {
    std::ostringstream why;
    why << "voxels of " << step.transpose() << " mm";
    damaged(h.file(), why.str());
  }
  Affine a = Affine::Zero();
  if (!quaternion) {
    a.leftCols<3>() = step.asDiagonal();
    return a;
  }
  Eigen::Quaterniond q(0.0, h.real(256), h.real(260), h.real(264));
  q.w() = std::sqrt(std::max(0.0, 1.0 - q.vec().squaredNorm()));
  q.normalize();
  if (h.step(0) < 0.0) step.z() = -step.z();
  a.leftCols<3>() = q.toRotationMatrix() * step.asDiagonal();
  for (int row = 0; row < 3; ++row) a(row, 3) = h.real(268 + 4 * static_cast<std::size_t>(row));
  return a;
}

Grid gridOf(const Header& h) {
  const bool hasSform = h.number16(254) > 0, hasQform = h.number16(252) > 0;
  const std::string form = hasSform ? "sform" : "qform";
  Affine a = hasSform ? sform(h) : ofSteps(h, hasQform);
  const Eigen::Vector3d lengths = a.leftCols<3>().colwise().norm();
  if (!a.allFinite() || lengths.minCoeff() <= 0.0)
    throw BadInput(quoted(h.file()) + ": the NIfTI " + form +
                   " is singular or not finite; no voxel position follows from it");
  const Eigen::Matrix3d axes = a.leftCols<3>() * lengths.cwiseInverse().asDiagonal();
  const double shear = (axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (shear > 1e-4) {
    std::ostringstream why;
    why << quoted(h.file()) << ": the NIfTI " << form << " is sheared (axes off a right angle by " << shear
        << " rad); resample the image to a regular grid";
    throw BadInput(why.str());
  }
  // The header holds single precision: the nearest axes at right angles are meant.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const int unit = h.byte(123) & 7;
  const double mm = unit == 1 ? 1e3 : unit == 3 ? 1e-3 : 1.0;
  const Eigen::Vector3d lpsOfRas(-1.0, -1.0, 1.0);
  Grid grid;
  for (int axis = 0; axis < 3; ++axis) grid.size[axis] = h.extent(axis + 1);
  grid.direction = lpsOfRas.asDiagonal() * svd.matrixU() * svd.matrixV().transpose();
  grid.spacing_mm = mm * lengths;
  grid.origin_lps_mm = mm * lpsOfRas.cwiseProduct(a.col(3));
  try {
    grid.check();
  } catch (const BadInput& e) {
    throw BadInput(quoted(h.file()) + ": " + e.what());
  }
  return grid;
}

/// The smallest rotation, in degrees, between axes, whichever of them is mirrored.
double turnedBy(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::Matrix3d r = from.transpose() * to;
  double least = 180.0;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3d turn = r;
    if (r.determinant() < 0.0) turn.col(axis) *= -1.0;
    const double cosine = std::clamp(0.5 * (turn.trace() - 1.0), -1.0, 1.0);
    least = std::min(least, std::acos(cosine) * 180.0 / std::numbers::pi);
  }
  return least;
}

/// What is doubtful about the place that gridOf took.
Diagnostics doubtsAbout(const Header& h, const Grid& grid) {
  constexpr double same_mm = 0.1, sameStep = 0.01;
  Diagnostics doubts;
  const bool hasSform = h.number16(254) > 0, hasQform = h.number16(252) > 0;
  if (!hasSform && !hasQform)
    doubts.add(DiagnosticCode::VolumePlaceUnknown, {{"missing", std::string("qform or sform")}});
  if (!hasSform) return doubts;
  const Affine s = sform(h);
  const bool steps = h.step(1) > 0.0 && h.step(2) > 0.0 && h.step(3) > 0.0;
  if (hasQform && steps) {
    const Affine q = ofSteps(h, true);
    double apart_mm = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector4d index(corner & 1 ? grid.size.x() - 1 : 0, corner & 2 ? grid.size.y() - 1 : 0,
                                  corner & 4 ? grid.size.z() - 1 : 0, 1.0);
      apart_mm = std::max(apart_mm, ((s - q) * index).norm() * grid.spacing_mm.x() / s.col(0).norm());
    }
    const Eigen::Matrix3d axesS = s.leftCols<3>().colwise().normalized(),
                          axesQ = q.leftCols<3>().colwise().normalized();
    const bool mirrored = axesS.determinant() * axesQ.determinant() < 0.0;
    if (apart_mm > same_mm || mirrored)
      doubts.add(DiagnosticCode::NiftiFormsDiffer,
                 {{"mm", apart_mm},
                  {"degrees", turnedBy(axesQ, axesS)},
                  {"handedness", std::string(mirrored ? "mirrored" : "not mirrored")}});
    return doubts;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double said = std::abs(h.step(axis + 1)), taken = s.col(axis).norm();
    if (!(said > 0.0) || std::abs(said - taken) <= sameStep * taken) continue;
    const double mm = grid.spacing_mm[axis] / taken;
    doubts.add(DiagnosticCode::NiftiStepsDiffer, {{"pixdim_mm", mm * said}, {"sform_mm", mm * taken}});
    break;
  }
  return doubts;
}

/// Bytes of a value of a datatype with one value per voxel; 0 for any other.
std::size_t bytesOfNiftiType(int datatype) {
  static const std::map<int, std::size_t> sizes = {{2, 1},   {4, 2},   {8, 4},   {16, 4},   {64, 8},
                                                   {256, 1}, {512, 2}, {768, 4}, {1024, 8}, {1280, 8}};
  const auto known = sizes.find(datatype);
  return known == sizes.end() ? 0 : known->second;
}

/// A volume with one value per voxel, or why not.
void checkShape(const Header& h) {
  const int dimensions = h.extent(0);
  if (dimensions < 1 || dimensions > 7) damaged(h.file(), std::to_string(dimensions) + " dimensions");
  for (int d = 1; d <= dimensions; ++d)
    if (h.extent(d) < 1) damaged(h.file(), std::to_string(h.extent(d)) + " voxels along axis " + std::to_string(d));
  if (dimensions < 3)
    throw BadInput(quoted(h.file()) + " has " + std::to_string(dimensions) +
                   " dimensions; its place in the patient is unknown: save it as a volume of one slice");
  const int datatype = h.number16(70);
  static const std::map<int, int> several = {{32, 2}, {128, 3}, {1792, 2}, {2048, 2}, {2304, 4}};
  int perVoxel = several.contains(datatype) ? several.at(datatype) : 1;
  for (int d = 5; d <= dimensions; ++d) perVoxel *= h.extent(d) > 1 ? h.extent(d) : 1;
  if (perVoxel != 1)
    throw BadInput(quoted(h.file()) +
                   " has several values per voxel; an image with one value per voxel is needed (a "
                   "colour copy holds no measured values)");
  if (dimensions > 3 && h.extent(4) > 1)
    throw BadInput(quoted(h.file()) + " has 4 dimensions (" + std::to_string(h.extent(4)) +
                   " time points); a 3-D volume is needed, so take one volume out of it first");
  if (bytesOfNiftiType(datatype) == 0) damaged(h.file(), "datatype " + std::to_string(datatype));
}

}  // namespace

NiftiFile readNifti(const std::filesystem::path& file, double mostBytes) {
  GzFile in(file);
  const Header header(in, file);
  checkShape(header);
  NiftiFile out;
  out.grid = gridOf(header);
  out.doubts = doubtsAbout(header, out.grid);
  out.datatype = header.number16(70);
  const std::size_t size = bytesOfNiftiType(out.datatype), voxels = out.grid.voxelCount();
  // Voxels read from another place than they were written to would be shifted and look like an image.
  const double begin = header.real(108);
  if (!(begin >= static_cast<double>(leastVoxelOffset)) || begin != std::floor(begin)) {
    std::ostringstream why;
    why << "its voxels are said to begin at byte " << begin << ", within the header of 352 bytes";
    damaged(file, why.str());
  }
  const double needed = begin + static_cast<double>(voxels) * static_cast<double>(size);
  const auto fileBytes = static_cast<double>(std::filesystem::file_size(file));
  if (needed > maxDeflateRatio * (fileBytes + 1024.0)) truncated(file, needed, fileBytes);
  if (needed > mostBytes) throw BadInput(quoted(file) + " does not fit into memory");
  std::vector<char> between(static_cast<std::size_t>(begin) - headerBytes);
  out.bytes.resize(voxels * size);
  const std::size_t there = headerBytes + in.read(between.data(), between.size());
  const std::size_t got = in.read(out.bytes.data(), out.bytes.size());
  if (got != out.bytes.size()) truncated(file, needed, static_cast<double>(there + got));
  if (header.big() && size > 1)
    for (std::size_t at = 0; at < out.bytes.size(); at += size)
      std::reverse(out.bytes.begin() + static_cast<std::ptrdiff_t>(at),
                   out.bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  const double slope = header.real(112), intercept = header.real(116);
  if (std::isfinite(slope) && slope != 0.0 && std::isfinite(intercept)) {
    out.slope = slope;
    out.intercept = intercept;
  }
  return out;
}

}  // namespace glisson::image::detail
