#include "dicom/pixels.h"

#include <cstring>

#include "base/error.h"

namespace glisson::dicom {
namespace {

/// Turns stored bytes (little endian) into values. bits: stored bits of an integer; the rest are overlays or padding.
template <typename Word>
void convertIntegers(const std::uint8_t* bytes, std::size_t count, int bits, bool isSigned, const Rescale& rescale,
                     float* values) {
  const auto mask = static_cast<std::uint64_t>(bits >= 64 ? ~0ULL : (1ULL << bits) - 1);
  const std::uint64_t signBit = 1ULL << (bits - 1);
  for (std::size_t n = 0; n < count; ++n) {
    Word word;
    std::memcpy(&word, bytes + n * sizeof(Word), sizeof(Word));
    const std::uint64_t raw = word & mask;
    const double stored =
        isSigned && (raw & signBit) != 0
            ? static_cast<double>(static_cast<std::int64_t>(raw) - static_cast<std::int64_t>(mask) - 1)
            : static_cast<double>(raw);
    values[n] = static_cast<float>(rescale.slope * stored + rescale.intercept);
  }
}

template <typename Real>
void convertReals(const std::uint8_t* bytes, std::size_t count, const Rescale& rescale, float* values) {
  for (std::size_t n = 0; n < count; ++n) {
    Real stored;
    std::memcpy(&stored, bytes + n * sizeof(Real), sizeof(Real));
    values[n] = static_cast<float>(rescale.slope * static_cast<double>(stored) + rescale.intercept);
  }
}

}  // namespace

PixelReader::PixelReader(const std::filesystem::path& file) {
  header_ = readHeaderSafely(file, &elsewhere_);
  if (const auto why = undecodable(header_.layout.transferSyntax)) throw BadInput(*why);
  if (elsewhere_) return;
  source_ = std::make_unique<ByteSource>(file);
  here_ = std::make_unique<StoredFrames>(header_, *source_);
}

PixelReader::~PixelReader() = default;

const std::vector<std::uint8_t>& PixelReader::picture(int number) {
  if (held_ == number) return bytes_;
  held_ = -1;
  bytes_ = here_ ? here_->read(number) : elsewhere_->frame(number, header_.frameBytes());
  held_ = number;
  return bytes_;
}

void PixelReader::read(const Frame& frame, float* values) {
  const std::uint8_t* bytes = picture(header_.isMosaic() ? 0 : frame.number).data();
  const auto integers = [&](const std::uint8_t* from, std::size_t count, float* to) {
    const auto convert = [&](auto word) {
      convertIntegers<decltype(word)>(from, count, header_.bitsStored, header_.isSigned, frame.rescale, to);
    };
    if (header_.bitsAllocated == 8)
      convert(std::uint8_t{});
    else if (header_.bitsAllocated == 16)
      convert(std::uint16_t{});
    else
      convert(std::uint32_t{});
  };
  const auto run = [&](const std::uint8_t* from, std::size_t count, float* to) {
    if (header_.kind == PixelKind::Float)
      convertReals<float>(from, count, frame.rescale, to);
    else if (header_.kind == PixelKind::Double)
      convertReals<double>(from, count, frame.rescale, to);
    else
      integers(from, count, to);
  };
  const auto columns = static_cast<std::size_t>(header_.sliceColumns());
  const auto rows = static_cast<std::size_t>(header_.sliceRows());
  if (!header_.isMosaic()) return run(bytes, rows * columns, values);
  const auto tile = static_cast<std::size_t>(frame.number);
  const auto perRow = static_cast<std::size_t>(header_.tile.perRow);
  const auto width = static_cast<std::size_t>(header_.columns);
  const auto bytesPerPixel = static_cast<std::size_t>(header_.bitsAllocated / 8);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t first = ((tile / perRow) * rows + row) * width + (tile % perRow) * columns;
    run(bytes + first * bytesPerPixel, columns, values + row * columns);
  }
}

}  // namespace glisson::dicom
