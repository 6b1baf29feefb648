#include "base/error.h"
#include "dicom/detail/naming.h"
#include "dicom/image_header.h"
#include "dicom/pixels.h"
#include "dicom/series.h"

namespace glisson::dicom {
namespace {

/// The frames of one file of the series, in the file's place in slice order.
void readFile(const Series& series, std::size_t index, image::ScalarVolume& volume) {
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
    if (series.frames.empty()) {
      if (header.frames.size() != 1 || header.isMosaic())
        throw BadInput("is no longer the image that was scanned; scan the folder again");
      reader.read(header.frames.front(), volume.values.data() + index * sliceSize);
      return;
    }
    for (std::size_t k = 0; k < series.frames.size(); ++k) {
      const auto frame = static_cast<std::size_t>(series.frames[k]);
      if (frame >= header.frames.size()) throw BadInput("has fewer frames than when it was scanned; scan it again");
      reader.read(header.frames[frame], volume.values.data() + k * sliceSize);
    }
  });
}

}  // namespace

image::ScalarVolume readSeries(const Series& series, const Progress& progress) {
  const std::string which = "series " + std::to_string(series.number) + " cannot be read as a volume: ";
  if (series.error) throw BadInput(which + *series.error);
  if (series.colour) throw BadInput(which + "its pixels are colours, not measured values");
  const std::size_t slices = series.frames.empty() ? series.files.size() : series.frames.size();
  if (series.files.empty() || slices != static_cast<std::size_t>(series.grid.size.z()) ||
      (!series.frames.empty() && series.files.size() != 1))
    throw BadInput(which + "its list of files does not match its number of slices");
  series.grid.check();
  image::ScalarVolume volume(series.grid);
  for (std::size_t n = 0; n < series.files.size(); ++n) {
    progress.report(static_cast<double>(n) / static_cast<double>(series.files.size()), "reading slices");
    readFile(series, n, volume);
  }
  progress.report(1.0, "reading slices");
  return volume;
}

}  // namespace glisson::dicom
