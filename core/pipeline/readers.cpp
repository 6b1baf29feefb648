// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/readers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "base/atomic_file.h"
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

/// What one case's readers have outlined, and what it was drawn on.
struct LoadedCase {
  std::string name;
  std::vector<LoadedRoi> rois;
  std::optional<LoadedStiffness> mre;
  std::optional<AnatomicalImage> mri;

  const LoadedStiffness* stiffness() const { return mre ? &*mre : nullptr; }
  const AnatomicalImage* image() const { return mri ? &*mri : nullptr; }
  std::optional<image::Grid> mriGrid() const { return mri ? std::optional(mri->volume.grid) : std::nullopt; }
};

/// Adds the warnings of one case, each once.
class CaseWarnings {
 public:
  CaseWarnings(std::string name, std::vector<std::string>& warnings) : name_(std::move(name)), warnings_(warnings) {}
  void add(const std::vector<std::string>& said) {
    for (const std::string& text : said)
      if (const std::string warning = name_ + ": " + text;
          std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
        warnings_.push_back(warning);
  }

 private:
  std::string name_;
  std::vector<std::string>& warnings_;
};

LoadedCase loadCase(const ReaderRequest& request, const std::string& name, bool many, const Progress& progress) {
  LoadedCase c;
  c.name = name;
  for (const auto& reader : request.readers)
    c.rois.push_back(loadRoi(ofCase(reader, name, many), request.name, request.label, progress));
  MapMeaning meaning = request.meaning;
  meaning.outlined = c.rois.front().names;
  meaning.mayBeUneven = true;
  if (!request.mre.empty()) c.mre = loadStiffness(ofCase(request.mre, name, many), meaning, progress);
  if (!request.mri.empty()) c.mri = loadImage(ofCase(request.mri, name, many), progress, {}, c.rois.front().names);
  return c;
}

/// Throws BadInput where the parts do not belong together.
void checkCase(const LoadedCase& c, bool overrideChecks, CaseWarnings& tell) {
  tell.add(checkReaders(c.rois, overrideChecks));
  if (c.mre) tell.add(c.mre->warnings);
  if (c.mri) tell.add(c.mri->diagnostics.texts(Severity::Warning));
  if (c.mri && c.mre) tell.add(checkTogether(*c.mri, *c.mre, overrideChecks));
  for (const LoadedRoi& roi : c.rois) {
    tell.add(roi.warnings);
    tell.add(checkRoi(roi, c.image(), c.stiffness(), overrideChecks));
    tell.add(doubtsAboutOutline(roi, c.image(), c.stiffness()).texts());
  }
}

/// The voxels that the readers are compared on: those of the first mask, else the image's, else the elastogram's.
/// Throws BadInput where there are none.
image::Grid gridOf(const LoadedCase& c) {
  for (const LoadedRoi& roi : c.rois)
    if (roi.mask) return roi.mask->grid;
  if (c.mri) return c.mri->volume.grid;
  if (!c.mre)
    throw BadInput("outlines alone have no voxels to compare: give the image they were drawn on, or the elastogram");
  if (!c.mre->map.unevenSlices_mm.empty())
    throw BadInput(
        "the elastogram's slices lie unevenly, so that outlines have no volume on it: give the image that they "
        "were drawn on (--mri)");
  return c.mre->map.values_kPa.grid;
}

/// Each reader's mask, and its volume.
std::vector<image::Mask> masksOf(LoadedCase& c, ReadersOfCase& result, CaseWarnings& tell) {
  const image::Grid grid = gridOf(c);
  const std::optional<image::Grid> mriGrid = c.mriGrid();
  std::vector<image::Mask> masks;
  for (LoadedRoi& roi : c.rois) {
    if (roi.contours) tell.add(roi::outlineDoubts(*roi.contours, grid, mriGrid.has_value()).texts(Severity::Warning));
    if (mriGrid)
      if (const auto completed = completeOutlines(roi, *mriGrid)) tell.add({*completed});
    masks.push_back(onGrid(roi, grid));
    const auto& values = masks.back().values;
    const auto voxels = std::count_if(values.begin(), values.end(), [](auto v) { return v != 0; });
    result.volume_mL.push_back(1e-3 * grid.voxelVolume_mm3() * static_cast<double>(voxels));
  }
  return masks;
}

/// What each reader's outline measures, and how far the others' are from the first.
void compareStiffness(const LoadedCase& c, ReadersOfCase& result, CaseWarnings& tell) {
  std::vector<elastography::Measurement> measurements;
  for (const LoadedRoi& roi : c.rois) {
    const elastography::MappedRoi mapped = mapRoi(roi, c.mriGrid(), c.mre->map);
    tell.add(mapped.warnings);
    const elastography::Measurement& m = measurements.emplace_back(elastography::measure(c.mre->map, mapped.mask));
    tell.add(m.warnings);
    result.stiffness_kPa.push_back(m.pooled.mean_kPa);
    result.stiffnessMean_kPa.push_back(m.interval.mean);
  }
  for (std::size_t r = 1; r < measurements.size(); ++r)
    result.intervals[r - 1].stiffnessDifference_kPa = detail::stiffnessDifference(measurements[0], measurements[r]);
}

ReadersOfCase compareCase(const ReaderRequest& request, const std::string& name, bool many,
                          std::vector<std::string>& warnings, const Progress& progress) {
  ReadersOfCase result;
  result.name = name;
  CaseWarnings tell(name, warnings);
  LoadedCase c = loadCase(request, name, many, progress);
  checkCase(c, request.overrideChecks, tell);
  const std::vector<image::Mask> masks = masksOf(c, result, tell);
  for (std::size_t r = 1; r < masks.size(); ++r) {
    result.agreement.push_back(
        roi::agreement(masks[0], masks[r], request.outlines ? roi::Border::Outline : roi::Border::Surface));
    detail::addOverlapIntervals(masks[0], masks[r], result.intervals.emplace_back());
  }
  if (c.mre) compareStiffness(c, result, tell);
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
  std::ostringstream csv;
  csv.precision(10);
  csv << "case,reader,quantity,value,unit\n";
  for (const ReadersOfCase& c : study.cases)
    for (std::size_t r = 0; r < c.volume_mL.size(); ++r) {
      const std::string start = '"' + c.name + "\"," + std::to_string(r + 1) + ',';
      csv << start << "volume," << c.volume_mL[r] << ",mL\n";
      if (!c.stiffness_kPa.empty()) csv << start << "mean stiffness," << c.stiffness_kPa[r] << ",kPa\n";
      if (r > 0) csv << start << "dice with reader 1," << c.agreement[r - 1].dice << ",1\n";
    }
  writeAtomically(files.back(), csv.str());
  const auto draw = [&](const std::optional<elastography::BlandAltman>& limits, const std::string& name,
                        const std::string& quantity, const std::string& unit) {
    if (!limits) return;
    const render::XyChart c = chart(*limits, quantity, unit);
    files.push_back(folder / ("bland-altman-" + name + ".png"));
    render::writePng(files.back(), render::draw(c));
    files.push_back(folder / ("bland-altman-" + name + ".svg"));
    writeAtomically(files.back(), render::svg(c));
  };
  draw(study.volumeLimits, "volume", "volume", "mL");
  draw(study.stiffnessLimits, "stiffness", "mean stiffness", "kPa");
  return files;
}

}  // namespace glisson::pipeline
