// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/detail/pixels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace glisson::dicom {
namespace {

/// Turns stored bytes (little endian) into values. bits: stored bits of an integer; the rest are overlays or padding.
template <typename Word, typename Value>
void convertIntegers(const std::uint8_t* bytes, std::size_t count, int bits, bool isSigned, const Value& value,
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
    values[n] = static_cast<float>(value(stored));
  }
}

template <typename Real, typename Value>
void convertReals(const std::uint8_t* bytes, std::size_t count, const Value& value, float* values) {
  for (std::size_t n = 0; n < count; ++n) {
    Real stored;
    std::memcpy(&stored, bytes + n * sizeof(Real), sizeof(Real));
    values[n] = static_cast<float>(value(static_cast<double>(stored)));
  }
}

/// Calls value(stored) for every pixel.
template <typename Value>
void convert(const ImageHeader& h, const std::uint8_t* bytes, std::size_t count, const Value& value, float* values) {
  if (h.kind == PixelKind::Float) return convertReals<float>(bytes, count, value, values);
  if (h.kind == PixelKind::Double) return convertReals<double>(bytes, count, value, values);
  if (h.bitsAllocated == 8) return convertIntegers<std::uint8_t>(bytes, count, h.bitsStored, h.isSigned, value, values);
  if (h.bitsAllocated == 16)
    return convertIntegers<std::uint16_t>(bytes, count, h.bitsStored, h.isSigned, value, values);
  convertIntegers<std::uint32_t>(bytes, count, h.bitsStored, h.isSigned, value, values);
}

/// The segment that a stored value is in, else the nearest one.
const ValueSegment& segmentOf(const ValueMap& map, double stored) {
  const ValueSegment* nearest = &map.front();
  double least = std::numeric_limits<double>::max();
  for (const ValueSegment& s : map) {
    const double away = std::max({s.first - stored, stored - s.last, 0.0});
    if (away < least) {
      nearest = &s;
      least = away;
    }
  }
  return *nearest;
}

bool inside(const ValueSegment& s, double stored) {
  return stored >= s.first && stored <= s.last;
}

double valueOf(const ValueSegment& s, double stored) {
  if (s.table.empty()) return s.line.slope * stored + s.line.intercept;
  const double entry = std::clamp(std::round(stored - s.first), 0.0, static_cast<double>(s.table.size()) - 1.0);
  return s.table[static_cast<std::size_t>(entry)];
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

template <typename Each>
void PixelReader::runs(const Frame& frame, float* values, const Each& each) {
  const std::uint8_t* bytes = picture(header_.isMosaic() ? 0 : frame.number).data();
  const auto columns = static_cast<std::size_t>(header_.sliceColumns());
  const auto rows = static_cast<std::size_t>(header_.sliceRows());
  if (!header_.isMosaic()) return each(bytes, rows * columns, values);
  const auto tile = static_cast<std::size_t>(frame.number);
  const auto perRow = static_cast<std::size_t>(header_.tile.perRow);
  const auto width = static_cast<std::size_t>(header_.columns);
  const auto bytesPerPixel = static_cast<std::size_t>(header_.bitsAllocated / 8);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t first = ((tile / perRow) * rows + row) * width + (tile % perRow) * columns;
    each(bytes + first * bytesPerPixel, columns, values + row * columns);
  }
}

void PixelReader::read(const Frame& frame, float* values) {
  runs(frame, values, [&](const std::uint8_t* from, std::size_t count, float* to) {
    if (frame.map < 0) {
      convert(
          header_, from, count, [r = frame.rescale](double stored) { return r.slope * stored + r.intercept; }, to);
      return;
    }
    const ValueMap& map = header_.maps[static_cast<std::size_t>(frame.map)];
    convert(
        header_, from, count, [&map](double stored) { return valueOf(segmentOf(map, stored), stored); }, to);
  });
}

PixelReader::Undefined PixelReader::readMap(const Frame& frame, float* values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const ValueMap line{{-std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), frame.rescale, {}}};
  const ValueMap& map = frame.map < 0 ? line : header_.maps[static_cast<std::size_t>(frame.map)];
  const std::pair<double, double> padding = header_.padding.value_or(std::pair(1.0, 0.0));
  Undefined undefined;
  runs(frame, values, [&](const std::uint8_t* from, std::size_t count, float* to) {
    convert(
        header_, from, count,
        [&](double stored) {
          if (stored >= padding.first && stored <= padding.second) {
            ++undefined.padding;
            return none;
          }
          const ValueSegment& segment = segmentOf(map, stored);
          if (inside(segment, stored)) return valueOf(segment, stored);
          if (std::isfinite(stored)) ++undefined.outsideRange;
          return none;
        },
        to);
  });
  return undefined;
}

}  // namespace glisson::dicom
