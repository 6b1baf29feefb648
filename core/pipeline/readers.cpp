#include "pipeline/readers.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "base/error.h"
#include "elastography/statistics.h"
#include "image/resample.h"
#include "pipeline/detail/reader_intervals.h"
#include "render/charts.h"
#include "roi/arrangement.h"

namespace glisson::pipeline {
namespace {

/// Name without extensions: "a.nii.gz" → "a".
std::string stem(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, name.find('.'));
}

std::map<std::string, std::filesystem::path> filesOf(const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.emplace(stem(entry.path()), entry.path());
  return files;
}

/// The file of a case: the path itself where it is a file (or a DICOM folder of a single comparison).
std::filesystem::path ofCase(const std::filesystem::path& path, const std::string& name, bool many) {
  if (path.empty() || !many) return path;
  const auto files = filesOf(path);
  const auto found = files.find(name);
  if (found == files.end()) throw BadInput("'" + path.filename().string() + "' holds nothing named '" + name + "'");
  return found->second;
}

std::vector<std::string> casesOf(const ReaderRequest& request, std::vector<std::string>& warnings) {
  std::map<std::string, std::size_t> readers;
  for (const auto& folder : request.readers)
    for (const auto& [name, file] : filesOf(folder)) ++readers[name];
  std::vector<std::string> cases;
  for (const auto& [name, count] : readers) {
    if (count == request.readers.size())
      cases.push_back(name);
    else
      warnings.push_back("'" + name + "' was outlined by " + std::to_string(count) + " of " +
                         std::to_string(request.readers.size()) + " readers: left out");
  }
  if (cases.empty()) throw BadInput("no case was outlined by all readers; files of one case need the same name");
  return cases;
}

image::Mask onGrid(const LoadedRoi& roi, const image::Grid& grid) {
  if (roi.mask) return roi.mask->grid.sameGeometry(grid) ? *roi.mask : image::resampleNearest(*roi.mask, grid);
  return roi::rasterise(*roi.contours, grid);
}

ReadersOfCase compareCase(const ReaderRequest& request, const std::string& name, bool many,
                          std::vector<std::string>& warnings, const Progress& progress) {
  ReadersOfCase result;
  result.name = name;
  std::vector<LoadedRoi> rois;
  for (const auto& reader : request.readers)
    rois.push_back(loadRoi(ofCase(reader, name, many), request.name, request.label, progress));
  std::optional<LoadedStiffness> mre;
  MapMeaning meaning = request.meaning;
  meaning.outlined = rois.front().names;
  meaning.mayBeUneven = true;
  if (!request.mre.empty()) mre = loadStiffness(ofCase(request.mre, name, many), meaning, progress);
  std::optional<image::Grid> grid, mriGrid;
  std::optional<AnatomicalImage> mri;
  if (!request.mri.empty()) mri = loadImage(ofCase(request.mri, name, many), progress, {}, rois.front().names);
  if (mri) mriGrid = mri->volume.grid;
  const auto tell = [&](const std::vector<std::string>& said) {
    for (const std::string& text : said)
      if (const std::string warning = name + ": " + text;
          std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
        warnings.push_back(warning);
  };
  tell(checkReaders(rois, request.overrideChecks));
  if (mre) tell(mre->warnings);
  if (mri) tell(mri->diagnostics.texts(Severity::Warning));
  if (mri && mre) tell(checkTogether(*mri, *mre, request.overrideChecks));
  for (const LoadedRoi& roi : rois) {
    tell(roi.warnings);
    tell(checkRoi(roi, mri ? &*mri : nullptr, mre ? &*mre : nullptr, request.overrideChecks));
    tell(doubtsAboutOutline(roi, mri ? &*mri : nullptr, mre ? &*mre : nullptr).texts());
  }
  for (const LoadedRoi& roi : rois)
    if (roi.mask && !grid) grid = roi.mask->grid;
  if (!grid) grid = mriGrid;
  if (!grid && mre && !mre->map.unevenSlices_mm.empty())
    throw BadInput("the elastogram's slices lie unevenly, so that outlines have no volume on it: give the image that they "
                   "were drawn on (--mri)");
  if (!grid && mre) grid = mre->map.values_kPa.grid;
  if (!grid)
    throw BadInput("outlines alone have no voxels to compare: give the image they were drawn on, or the elastogram");
  std::vector<image::Mask> masks;
  for (LoadedRoi& roi : rois) {
    if (roi.contours) tell(roi::outlineDoubts(*roi.contours, *grid, mriGrid.has_value()).texts(Severity::Warning));
    if (mriGrid)
      if (const auto completed = completeOutlines(roi, *mriGrid)) tell({*completed});
    masks.push_back(onGrid(roi, *grid));
    result.volume_mL.push_back(1e-3 * grid->voxelVolume_mm3() *
                               static_cast<double>(std::count_if(masks.back().values.begin(), masks.back().values.end(),
                                                                 [](auto v) { return v != 0; })));
  }
  for (std::size_t r = 1; r < masks.size(); ++r) {
    result.agreement.push_back(
        roi::agreement(masks[0], masks[r], request.outlines ? roi::Border::Outline : roi::Border::Surface));
    detail::addOverlapIntervals(masks[0], masks[r], result.intervals.emplace_back());
  }
  if (!mre) return result;
  std::vector<elastography::Measurement> measurements;
  for (const LoadedRoi& roi : rois) {
    const elastography::MappedRoi mapped = mapRoi(roi, mriGrid, mre->map);
    tell(mapped.warnings);
    const elastography::Measurement& measured =
        measurements.emplace_back(elastography::measure(mre->map, mapped.mask));
    tell(measured.warnings);
    result.stiffness_kPa.push_back(measured.pooled.mean_kPa);
    result.stiffnessMean_kPa.push_back(measured.interval.mean);
  }
  for (std::size_t r = 1; r < measurements.size(); ++r)
    result.intervals[r - 1].stiffnessDifference_kPa = detail::stiffnessDifference(measurements[0], measurements[r]);
  return result;
}

/// Reliability and limits of one quantity over the cases.
template <typename Values>
void overCases(const ReaderStudy& study, std::size_t readers, const Values& values,
               std::optional<elastography::ReaderReliability>& reliability,
               std::optional<elastography::BlandAltman>& limits, std::vector<std::string>& warnings) {
  const std::size_t n = study.cases.size();
  if (n < 2) return;
  Eigen::MatrixXd table(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(readers));
  std::vector<double> first, second;
  for (std::size_t c = 0; c < n; ++c) {
    const std::vector<double>& row = values(study.cases[c]);
    for (std::size_t r = 0; r < readers; ++r)
      table(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(r)) = row[r];
    first.push_back(row[0]);
    second.push_back(row[1]);
  }
  try {
    reliability = elastography::readerReliability(table);
    if (n >= 3) limits = elastography::blandAltman(first, second);
  } catch (const BadInput& e) {
    warnings.emplace_back(e.what());
  }
}

render::XyChart chart(const elastography::BlandAltman& limits, const std::string& quantity, const std::string& unit) {
  render::XyChart c;
  c.title = "Second reader against first: " + quantity;
  c.x.title = "Mean of both readers (" + unit + ")";
  c.y.title = "Second - first (" + unit + ")";
  c.series.push_back({.name = "cases", .x = limits.mean, .y = limits.difference, .joined = false});
  c.lines.push_back({.value = limits.bias, .label = "bias", .colour = {60, 60, 60}});
  c.lines.push_back({.value = limits.lowLimit, .label = "bias - 1.96 SD", .colour = {200, 0, 160}});
  c.lines.push_back({.value = limits.highLimit, .label = "bias + 1.96 SD", .colour = {200, 0, 160}});
  c.caption = "Research use only, not for clinical use.";
  return c;
}

}  // namespace

ReaderStudy compareReaders(const ReaderRequest& request, const Progress& progress) {
  if (request.readers.size() < 2) throw BadInput("agreement needs the outlines of at least two readers");
  std::size_t folders = 0;
  for (const auto& reader : request.readers) {
    if (!std::filesystem::exists(reader)) throw BadInput("there is no '" + reader.filename().string() + "'");
    folders += std::filesystem::is_directory(reader) ? 1 : 0;
  }
  if (folders != 0 && folders != request.readers.size())
    throw BadInput("some readers are folders and some are files; give either one file or one folder for each");
  const bool many = folders != 0;
  ReaderStudy study;
  const std::vector<std::string> cases =
      many ? casesOf(request, study.warnings) : std::vector<std::string>{stem(request.readers.front())};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    progress.report(static_cast<double>(c) / static_cast<double>(cases.size()), "case " + std::to_string(c + 1));
    study.cases.push_back(compareCase(request, cases[c], many, study.warnings, progress.part(0.0, 0.0)));
  }
  const std::size_t readers = request.readers.size();
  const auto volumes = [](const ReadersOfCase& c) -> const std::vector<double>& { return c.volume_mL; };
  const auto stiffness = [](const ReadersOfCase& c) -> const std::vector<double>& { return c.stiffness_kPa; };
  overCases(study, readers, volumes, study.volume, study.volumeLimits, study.warnings);
  if (!request.mre.empty())
    overCases(study, readers, stiffness, study.stiffness, study.stiffnessLimits, study.warnings);
  progress.report(1.0, "compared");
  return study;
}

std::vector<std::filesystem::path> writeReaders(const std::filesystem::path& folder, const ReaderStudy& study) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw BadInput("the folder '" + folder.filename().string() + "' cannot be made: " + failed.message());
  std::vector<std::filesystem::path> files{folder / "readers.csv"};
  std::ofstream csv(files.back());
  csv.precision(10);
  csv << "case,reader,quantity,value,unit\n";
  for (const ReadersOfCase& c : study.cases)
    for (std::size_t r = 0; r < c.volume_mL.size(); ++r) {
      const std::string start = '"' + c.name + "\"," + std::to_string(r + 1) + ',';
      csv << start << "volume," << c.volume_mL[r] << ",mL\n";
      if (!c.stiffness_kPa.empty()) csv << start << "mean stiffness," << c.stiffness_kPa[r] << ",kPa\n";
      if (r > 0) csv << start << "dice with reader 1," << c.agreement[r - 1].dice << ",1\n";
    }
  if (!csv.flush()) throw BadInput("the table of readers could not be written");
  const auto draw = [&](const std::optional<elastography::BlandAltman>& limits, const std::string& name,
                        const std::string& quantity, const std::string& unit) {
    if (!limits) return;
    const render::XyChart c = chart(*limits, quantity, unit);
    files.push_back(folder / ("bland-altman-" + name + ".png"));
    render::writePng(files.back(), render::draw(c));
    files.push_back(folder / ("bland-altman-" + name + ".svg"));
    std::ofstream(files.back()) << render::svg(c);
  };
  draw(study.volumeLimits, "volume", "volume", "mL");
  draw(study.stiffnessLimits, "stiffness", "mean stiffness", "kPa");
  return files;
}

}  // namespace glisson::pipeline
