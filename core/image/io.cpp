// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/io.h"

#include <fcntl.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <sstream>

#include "base/error.h"
#include "base/part_file.h"
#include "base/text.h"
#include "image/detail/completeness.h"
#include "image/detail/nifti.h"
#include "image/detail/nrrd.h"

namespace glisson::image {
namespace {

using ImageIO = itk::ImageIOBase;

enum class Format { Unknown, Nifti, NiftiGz, Nrrd, Meta };

/// Bytes of voxels that a file may ask for before it is refused.
constexpr double maxVoxelBytes = 4.0 * 1024 * 1024 * 1024;
/// Deflate cannot shrink more than 1032:1, so a file that promises more than this holds less than it says.
constexpr double maxDeflateRatio = 1040.0;

Format formatOf(const std::filesystem::path& file) {
  const std::string name = lowerCase(file.filename().string());
  const auto ends = [&name](const char* end) { return name.size() > std::strlen(end) && name.ends_with(end); };
  if (ends(".nii.gz")) return Format::NiftiGz;
  if (ends(".nii")) return Format::Nifti;
  if (ends(".nrrd") || ends(".nhdr")) return Format::Nrrd;
  if (ends(".mha") || ends(".mhd")) return Format::Meta;
  return Format::Unknown;
}

/// The format libraries write about damaged files to the standard error stream of the process, past any setting of
/// theirs; the user gets one line, ours. One at a time, because the stream is the whole process's.
class QuietStderr {
 public:
  QuietStderr() : lock_(mutex()) {
    std::fflush(stderr);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    before_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    if (before_ >= 0) dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~QuietStderr() {
    if (before_ < 0) return;
    std::cerr.flush();
    std::fflush(stderr);
    dup2(before_, STDERR_FILENO);
    close(before_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  int before_ = -1;
};

/// A fixed reader for the format; never ITK's factory, which would try GDCM on anything.
ImageIO::Pointer makeIO(Format format) {
  switch (format) {
    case Format::Nifti:
    case Format::NiftiGz: return itk::NiftiImageIO::New().GetPointer();
    case Format::Nrrd: return itk::NrrdImageIO::New().GetPointer();
    case Format::Meta: return itk::MetaImageIO::New().GetPointer();
    case Format::Unknown: break;
  }
  return nullptr;
}

std::string quoted(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

Grid gridOf(const ImageIO& io, const std::filesystem::path& file) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  const bool oneTimePoint = dimensions == 4 && io.GetDimensions(3) == 1;
  if (dimensions != 3 && !oneTimePoint) {
    std::ostringstream why;
    why << quoted(file) << " has " << dimensions << " dimensions";
    if (dimensions == 4) why << " (" << io.GetDimensions(3) << " time points)";
    why << (dimensions < 3 ? "; its place in the patient is unknown: save it as a volume of one slice"
                           : "; a 3-D volume is needed, so take one volume out of it first");
    throw BadInput(why.str());
  }
  if (io.GetNumberOfComponents() != 1)
    throw BadInput(quoted(file) + " has " + std::to_string(io.GetNumberOfComponents()) +
                   " values per voxel; an image with one value per voxel is needed (a colour copy holds no measured "
                   "values)");
  Grid grid;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto n = io.GetDimensions(axis);
    if (n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw BadInput(quoted(file) + " announces " + std::to_string(n) + " voxels along one axis");
    const auto row = static_cast<Eigen::Index>(axis);
    grid.size[row] = static_cast<int>(n);
    grid.spacing_mm[row] = io.GetSpacing(axis);
    grid.origin_lps_mm[row] = io.GetOrigin(axis);
    const std::vector<double> direction = io.GetDirection(axis);
    for (unsigned component = 0; component < 3; ++component)
      grid.direction(static_cast<Eigen::Index>(component), row) = direction[component];
  }
  try {
    grid.check();
  } catch (const BadInput& e) {
    throw BadInput(quoted(file) + ": " + e.what());
  }
  return grid;
}

/// What a file says about its stored values: value = slope · stored + intercept.
struct Rescale {
  double slope = 1.0, intercept = 0.0;
  bool changes() const { return slope != 1.0 || intercept != 0.0; }
};

template <typename From, typename To>
void convert(const std::vector<char>& bytes, std::vector<To>& values, const std::filesystem::path& file,
             const Rescale& rescale) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    From from;
    std::memcpy(&from, bytes.data() + n * sizeof(From), sizeof(From));
    if constexpr (std::is_integral_v<To>) {
      const double x = rescale.slope * static_cast<double>(from) + rescale.intercept;
      if (std::isnan(x)) {  // no number, no label
        values[n] = 0;
        continue;
      }
      const double rounded = std::round(x);
      if (!(std::abs(x - rounded) <= 1e-3) || std::abs(rounded) > 2147483647.0) {
        std::ostringstream why;
        why << quoted(file) << " holds the value " << x << " (voxel number " << n
            << "); labels must be whole numbers. Is this an image rather than a mask?";
        throw BadInput(why.str());
      }
      values[n] = static_cast<To>(rounded);
    } else {
      values[n] = rescale.changes() ? static_cast<To>(rescale.slope * static_cast<double>(from) + rescale.intercept)
                                    : static_cast<To>(from);
    }
  }
}

template <typename To>
void convertAny(ImageIO::IOComponentEnum type, const std::vector<char>& bytes, std::vector<To>& values,
                const std::filesystem::path& file, const Rescale& rescale = {}) {
  using Type = ImageIO::IOComponentEnum;
  switch (type) {
    case Type::UCHAR: return convert<unsigned char>(bytes, values, file, rescale);
    case Type::CHAR: return convert<signed char>(bytes, values, file, rescale);
    case Type::USHORT: return convert<unsigned short>(bytes, values, file, rescale);
    case Type::SHORT: return convert<short>(bytes, values, file, rescale);
    case Type::UINT: return convert<unsigned int>(bytes, values, file, rescale);
    case Type::INT: return convert<int>(bytes, values, file, rescale);
    case Type::ULONG: return convert<unsigned long>(bytes, values, file, rescale);
    case Type::LONG: return convert<long>(bytes, values, file, rescale);
    case Type::ULONGLONG: return convert<unsigned long long>(bytes, values, file, rescale);
    case Type::LONGLONG: return convert<long long>(bytes, values, file, rescale);
    case Type::FLOAT: return convert<float>(bytes, values, file, rescale);
    case Type::DOUBLE: return convert<double>(bytes, values, file, rescale);
    default:
      throw BadInput(quoted(file) + " holds values of a kind that cannot be read (neither whole numbers nor reals)");
  }
}

template <typename T>
Volume<T> fromNifti(const std::filesystem::path& file, Diagnostics* doubts) {
  using Type = ImageIO::IOComponentEnum;
  static const std::map<int, Type> types = {
      {2, Type::UCHAR},  {4, Type::SHORT},    {8, Type::INT},    {16, Type::FLOAT},      {64, Type::DOUBLE},
      {256, Type::CHAR}, {512, Type::USHORT}, {768, Type::UINT}, {1024, Type::LONGLONG}, {1280, Type::ULONGLONG}};
  const detail::NiftiFile nifti = detail::readNifti(file, maxVoxelBytes);
  if (doubts != nullptr) doubts->add(nifti.doubts);
  Volume<T> volume;
  volume.grid = nifti.grid;
  doubtVoxelSize(volume.grid, doubts);
  volume.values.resize(volume.grid.voxelCount());
  convertAny(types.at(nifti.datatype), nifti.bytes, volume.values, file, {nifti.slope, nifti.intercept});
  return volume;
}

template <typename T>
Volume<T> read(const std::filesystem::path& file, Diagnostics* doubts) {
  const Format format = formatOf(file);
  if (format == Format::Unknown)
    throw BadInput(quoted(file) + " is no volume file by its extension (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd)");
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) throw BadInput(quoted(file) + " is not there, or is no file");
  if (format == Format::Meta) checkMetaImage(file, doubts);
  const detail::TextHeader nrrd = format == Format::Nrrd ? detail::checkedNrrd(file) : detail::TextHeader{};
  try {
    if (format == Format::Nifti || format == Format::NiftiGz) return fromNifti<T>(file, doubts);
    const QuietStderr quiet;
    const ImageIO::Pointer io = makeIO(format);
    if (!io->CanReadFile(file.c_str()))
      throw BadInput(quoted(file) + " is not what its extension says, or its header is damaged");
    io->SetFileName(file.string());
    io->ReadImageInformation();
    Volume<T> volume;
    volume.grid = gridOf(*io, file);
    if (format == Format::Nrrd) detail::completeNrrd(nrrd, file, volume.grid, doubts);
    if (format == Format::Meta) completeMetaImage(file, volume.grid, doubts);
    doubtVoxelSize(volume.grid, doubts);
    const double bytes = static_cast<double>(volume.grid.voxelCount()) * io->GetComponentSize();
    const bool detached = file.extension() == ".nhdr" || file.extension() == ".mhd";
    const auto fileBytes = static_cast<double>(std::filesystem::file_size(file));
    if (bytes > maxVoxelBytes || (!detached && bytes > maxDeflateRatio * (fileBytes + 1024.0))) {
      std::ostringstream why;
      why << quoted(file) << " announces " << volume.grid.size.transpose() << " voxels (" << bytes
          << " bytes), more than this file of " << fileBytes << " bytes can hold or than fits into memory";
      throw BadInput(why.str());
    }
    itk::ImageIORegion region(io->GetNumberOfDimensions());
    for (unsigned axis = 0; axis < io->GetNumberOfDimensions(); ++axis) region.SetSize(axis, io->GetDimensions(axis));
    io->SetIORegion(region);
    std::vector<char> raw(static_cast<std::size_t>(bytes));
    io->Read(raw.data());
    volume.values.resize(volume.grid.voxelCount());
    convertAny(io->GetComponentType(), raw, volume.values, file);
    return volume;
  } catch (const itk::ExceptionObject&) {
    throw BadInput(quoted(file) + " cannot be read: it is truncated, damaged, or not what its extension says");
  } catch (const std::bad_alloc&) {
    throw BadInput(quoted(file) + " does not fit into memory");
  }
}

void write(const std::filesystem::path& file, const Grid& grid, ImageIO::IOComponentEnum type, unsigned components,
           const void* data) {
  const Format format = formatOf(file);
  const std::string extension = file.extension().string();
  if (format == Format::Unknown || extension == ".nhdr" || extension == ".mhd")
    throw BadInput(quoted(file) + ": a volume is written as .nii, .nii.gz, .nrrd or .mha; choose one of these names");
  if (components != 1 && format != Format::Nrrd && format != Format::Meta)
    throw BadInput(quoted(file) +
                   ": NIfTI readers disagree on the axes of vectors; write a displacement field as .nrrd or .mha");
  const char* ending = format == Format::NiftiGz ? ".nii.gz" : format == Format::Nifti ? ".nii" : nullptr;
  std::error_code ignored;
  if (!std::filesystem::is_directory(file.has_parent_path() ? file.parent_path() : ".", ignored))
    throw BadInput(quoted(file) + " cannot be written: its folder is not there");
  PartFile part(file, ending != nullptr ? ending : extension);
  try {
    const ImageIO::Pointer io = makeIO(format);
    io->SetFileName(part.path().string());
    io->SetNumberOfDimensions(3);
    itk::ImageIORegion region(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      io->SetDimensions(axis, static_cast<std::size_t>(grid.size[row]));
      io->SetSpacing(axis, grid.spacing_mm[row]);
      io->SetOrigin(axis, grid.origin_lps_mm[row]);
      io->SetDirection(axis,
                       std::vector<double>{grid.direction(0, row), grid.direction(1, row), grid.direction(2, row)});
      region.SetSize(axis, static_cast<std::size_t>(grid.size[row]));
    }
    io->SetIORegion(region);
    io->SetComponentType(type);
    io->SetPixelType(components == 1 ? itk::IOPixelEnum::SCALAR : itk::IOPixelEnum::VECTOR);
    io->SetNumberOfComponents(components);
    io->SetUseCompression(format != Format::Nifti);
    io->WriteImageInformation();
    io->Write(data);
    part.become();
  } catch (const itk::ExceptionObject&) {
    throw BadInput(quoted(file) + " cannot be written; is the folder there, writable, and the disk not full?");
  }
}

}  // namespace

ScalarVolume readVolume(const std::filesystem::path& file, Diagnostics* doubts) {
  return read<float>(file, doubts);
}

LabelMap readLabelMap(const std::filesystem::path& file, Diagnostics* doubts) {
  return read<std::int32_t>(file, doubts);
}

Mask readMask(const std::filesystem::path& file, int label, Diagnostics* doubts) {
  const LabelMap labels = readLabelMap(file, doubts);
  Mask mask(labels.grid);
  bool any = false;
  for (std::size_t n = 0; n < labels.values.size(); ++n) {
    const bool inside = label == 0 ? labels.values[n] != 0 : labels.values[n] == label;
    mask.values[n] = inside ? 1 : 0;
    any = any || inside;
  }
  if (any) return mask;
  std::set<std::int32_t> there(labels.values.begin(), labels.values.end());
  there.erase(0);
  std::ostringstream why;
  why << quoted(file);
  if (there.empty()) {
    why << " is zero everywhere: there is nothing to select";
  } else {
    why << " has no voxel with label " << label << "; it holds the labels";
    int shown = 0;
    for (const std::int32_t value : there) {
      if (++shown > 20) {
        why << " ... (" << there.size() << " in all)";
        break;
      }
      why << ' ' << value;
    }
  }
  throw BadInput(why.str());
}

bool isVolumeFile(const std::filesystem::path& file) {
  return formatOf(file) != Format::Unknown;
}

void writeVolume(const std::filesystem::path& file, const ScalarVolume& volume) {
  write(file, volume.grid, itk::IOComponentEnum::FLOAT, 1, volume.values.data());
}

void writeVolume(const std::filesystem::path& file, const Mask& mask) {
  write(file, mask.grid, itk::IOComponentEnum::UCHAR, 1, mask.values.data());
}

void writeVolume(const std::filesystem::path& file, const LabelMap& labels) {
  write(file, labels.grid, itk::IOComponentEnum::INT, 1, labels.values.data());
}

void writeVolume(const std::filesystem::path& file, const DisplacementField& u_mm) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "a field is written as it lies in memory");
  write(file, u_mm.grid, itk::IOComponentEnum::FLOAT, 3, u_mm.values.data());
}

}  // namespace glisson::image
