#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include "base/error.h"
#include "render/picture.h"

namespace glisson::render {
namespace {

/// CRC-32 of a PNG chunk (ISO 3309), over its type and data.
std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count) {
  std::uint32_t crc = 0xffffffffU;
  for (std::size_t n = 0; n < count; ++n) {
    crc ^= bytes[n];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) ? 0xedb88320U : 0U);
  }
  return ~crc;
}

void putBigEndian(std::uint8_t* to, std::uint32_t v) {
  for (int n = 0; n < 4; ++n) to[n] = static_cast<std::uint8_t>(v >> (24 - 8 * n));
}

/// Length, type, pixels per metre in x and y, unit 1 (metre), CRC.
std::array<std::uint8_t, 21> physicalSizeChunk(double dpi) {
  const auto perMetre = static_cast<std::uint32_t>(std::lround(dpi / 0.0254));
  std::array<std::uint8_t, 21> chunk{};
  putBigEndian(chunk.data(), 9);
  std::memcpy(chunk.data() + 4, "pHYs", 4);
  putBigEndian(chunk.data() + 8, perMetre);
  putBigEndian(chunk.data() + 12, perMetre);
  chunk[16] = 1;
  putBigEndian(chunk.data() + 17, crc32(chunk.data() + 4, 13));
  return chunk;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Picture& picture, double dpi) {
  if (picture.width < 1 || picture.height < 1 ||
      picture.rgb.size() != 3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))
    throw BadArgument("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                      " pixels with " + std::to_string(picture.rgb.size()) + " bytes cannot be encoded as PNG");
  if (!(dpi > 0.0) || dpi > 1e5) throw BadArgument("a resolution of " + std::to_string(dpi) + " dpi is not usable");

  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
  const std::size_t row = 3 * static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  for (std::size_t y = 0; y < height; ++y)  // VTK counts rows from the bottom
    std::memcpy(to + (height - 1 - y) * row, picture.rgb.data() + y * row, row);

  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  const vtkUnsignedCharArray* result = writer->GetResult();
  if (!result || result->GetNumberOfValues() < 33) throw Error("the PNG encoder gave no bytes");
  const std::uint8_t* bytes = const_cast<vtkUnsignedCharArray*>(result)->GetPointer(0);
  const auto count = static_cast<std::size_t>(result->GetNumberOfValues());

  const std::size_t afterHeader = 8 + 4 + 4 + 13 + 4;  // signature and the IHDR chunk; VTK's writer has no resolution
  const auto chunk = physicalSizeChunk(dpi);
  std::vector<std::uint8_t> png(count + chunk.size());
  std::memcpy(png.data(), bytes, afterHeader);
  std::memcpy(png.data() + afterHeader, chunk.data(), chunk.size());
  std::memcpy(png.data() + afterHeader + chunk.size(), bytes + afterHeader, count - afterHeader);
  return png;
}

void writePng(const std::filesystem::path& file, const Picture& picture, double dpi) {
  const std::vector<std::uint8_t> png = encodePng(picture, dpi);
  std::filesystem::path beside = file;
  beside += ".part";
  {
    std::ofstream out(beside, std::ios::binary);
    out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    out.flush();
    if (!out) {
      std::error_code ignored;
      std::filesystem::remove(beside, ignored);
      throw BadInput("cannot write the picture '" + file.filename().string() +
                     "': the folder is missing, read-only or full; choose another output folder");
    }
  }
  std::error_code failed;
  std::filesystem::rename(beside, file, failed);
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw BadInput("cannot write the picture '" + file.filename().string() + "': " + failed.message());
  }
}

}  // namespace glisson::render
