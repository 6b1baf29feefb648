// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"
#include "base/map_unit.h"
#include "dicom/detail/image_header.h"
#include "dicom/detail/naming.h"
#include "dicom/detail/pixels.h"
#include "dicom/series.h"

namespace glisson::dicom {
namespace {

/// What a value of the frame is in the unit of its series.
double toUnitOf(const Series& series, const Frame& frame) {
  if (!series.unit || frame.unit.empty() || frame.unit == *series.unit) return 1.0;
  const auto from = mapUnit(frame.unit), to = mapUnit(*series.unit);
  return from && to && from->of == to->of ? from->factor / to->factor : 1.0;
}

/// The frames of one file of the series, in the file's place in slice order. map: with what holds no value taken out
/// and counted; null: as stored.
void readFile(const Series& series, std::size_t index, image::ScalarVolume& volume, ReadMap* map) {
  const std::filesystem::path& file = series.files[index];
  const std::size_t sliceSize =
      static_cast<std::size_t>(volume.grid.size.x()) * static_cast<std::size_t>(volume.grid.size.y());
  detail::naming(file, [&] {
    PixelReader reader(file);
    const ImageHeader& header = reader.header();
    const std::size_t base = series.uid.find('#');
    if (header.sliceRows() != volume.grid.size.y() || header.sliceColumns() != volume.grid.size.x() ||
        header.colour() || header.seriesUid != series.uid.substr(0, base))
      throw BadInput("is no longer the image that was scanned; scan the folder again");
    const auto slice = [&](const Frame& frame, float* values) {
      if (map == nullptr) {
        reader.read(frame, values);
      } else {
        const PixelReader::Undefined undefined = reader.readMap(frame, values);
        map->padding += undefined.padding;
        map->outsideRange += undefined.outsideRange;
      }
      if (const double factor = toUnitOf(series, frame); factor != 1.0)
        for (std::size_t n = 0; n < sliceSize; ++n)
          values[n] = static_cast<float>(factor * static_cast<double>(values[n]));
    };
    if (series.frames.empty()) {
      if (header.frames.size() != 1 || header.isMosaic())
        throw BadInput("is no longer the image that was scanned; scan the folder again");
      slice(header.frames.front(), volume.values.data() + index * sliceSize);
      return;
    }
    for (std::size_t k = 0; k < series.frames.size(); ++k) {
      if (!series.fileOfSlice.empty() && static_cast<std::size_t>(series.fileOfSlice[k]) != index) continue;
      const auto frame = static_cast<std::size_t>(series.frames[k]);
      if (frame >= header.frames.size()) throw BadInput("has fewer frames than when it was scanned; scan it again");
      slice(header.frames[frame], volume.values.data() + k * sliceSize);
    }
  });
}

std::string cannotBeRead(const Series& series) {
  return "series " + std::to_string(series.number) + " cannot be read as a volume: ";
}

image::ScalarVolume readFiles(const Series& series, const Progress& progress, ReadMap* map) {
  const std::string which = cannotBeRead(series);
  if (series.error) throw BadInput(which + *series.error);
  if (series.colour) throw BadInput(which + "its pixels are colours, not measured values");
  const std::size_t slices = series.frames.empty() ? series.files.size() : series.frames.size();
  if (series.files.empty() || slices != static_cast<std::size_t>(series.grid.size.z()) ||
      (!series.frames.empty() &&
       (series.fileOfSlice.empty() ? series.files.size() != 1 : series.fileOfSlice.size() != series.frames.size())))
    throw BadInput(which + "its list of files does not match its number of slices");
  series.grid.check();
  image::ScalarVolume volume(series.grid);
  for (std::size_t n = 0; n < series.files.size(); ++n) {
    progress.report(static_cast<double>(n) / static_cast<double>(series.files.size()), "reading slices");
    readFile(series, n, volume, map);
  }
  progress.report(1.0, "reading slices");
  return volume;
}

}  // namespace

image::ScalarVolume readSeries(const Series& series, const Progress& progress) {
  return readFiles(series, progress, nullptr);
}

ReadMap readMap(const Series& series, const Progress& progress) {
  if (!series.error && series.noScale)
    throw BadInput("the values of series " + std::to_string(series.number) + " are no measure: " + *series.noScale +
                   "; export it again with one scale and one unit");
  ReadMap map;
  map.values = readFiles(series, progress, &map);
  return map;
}

Series asStack(const Series& series) {
  Series stack = series;
  if (!series.unevenSlices_mm.empty()) stack.error.reset();
  return stack;
}

}  // namespace glisson::dicom
