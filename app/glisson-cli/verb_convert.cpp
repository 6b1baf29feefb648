// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "dicom/series.h"
#include "image/io.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct ConvertArguments {
  std::filesystem::path in, out;
  std::string series;
};

/// "number 401, stiffness, 256 x 256 x 12": to choose by, with the UID where the number does not tell.
std::string shown(const dicom::Series& s, bool uid) {
  std::ostringstream text;
  text << "number " << s.number << ", " << name(s.role) << ", " << s.grid.size.x() << " x " << s.grid.size.y() << " x "
       << s.grid.size.z();
  if (uid) text << ", UID " << s.uid;
  return text.str();
}

/// The series that is asked for, else the only one that is an anatomical image, else the only one that there is.
const dicom::Series& chosen(const dicom::ScanResult& scan, const std::string& asked) {
  std::vector<const dicom::Series*> fit, usable;
  for (const dicom::Series& s : scan.series) {
    if (asked.empty() ? !s.error && s.role == dicom::SeriesRole::Anatomical
                      : s.uid == asked || name(s.role) == asked || std::to_string(s.number) == asked)
      fit.push_back(&s);
    if (!s.error) usable.push_back(&s);
  }
  if (asked.empty() && fit.empty()) fit = usable;
  if (fit.empty() && !scan.series.empty() && asked.empty()) return scan.series.front();  // which says why it is refused
  if (fit.empty() && scan.series.empty())
    throw BadInput(scan.skipped.empty() ? "no image series was found"
                                        : "no image series was found: " + scan.skipped.front().reason);
  if (fit.size() == 1) return *fit.front();
  std::set<int> numbers;
  for (const dicom::Series* s : fit) numbers.insert(s->number);
  const bool byUid = numbers.size() < fit.size();
  std::string list;
  for (std::size_t n = 0; n < std::min<std::size_t>(fit.size(), 12); ++n)
    list += (n > 0 ? "; " : "") + shown(*fit[n], byUid);
  if (fit.size() > 12) list += "; and " + std::to_string(fit.size() - 12) + " more";
  if (fit.empty())
    throw BadInput("no series has the UID, number or role '" + asked.substr(0, 70) +
                   "'; list them with: glisson-cli scan");
  throw BadInput(std::to_string(fit.size()) + " series fit, choose one with --series and its " +
                 (byUid ? "UID" : "number, role or UID") + ": " + list);
}

/// The values of a map with not-a-number where it holds none; of every other image as they are.
image::ScalarVolume read(const dicom::Series& series, Diagnostics& said, const Progress& progress) {
  if (series.role != dicom::SeriesRole::Stiffness && series.role != dicom::SeriesRole::Confidence)
    return dicom::readSeries(series, progress);
  dicom::ReadMap map = dicom::readMap(series, progress);
  if (map.padding > 0) said.add(DiagnosticCode::PaddingLeftOut, {{"voxels", map.padding}});
  if (map.outsideRange > 0) said.add(DiagnosticCode::OutsideMappedRange, {{"voxels", map.outsideRange}});
  return std::move(map.values);
}

}  // namespace

void addConvert(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("convert", "a series or volume to NIfTI, NRRD or MetaImage, geometry kept");
  auto a = std::make_shared<ConvertArguments>();
  verb->add_option("in", a->in, "DICOM folder or file, or a volume")->type_name(value::folderOrFile)->required();
  verb->add_option("out", a->out, "file to write: .nii, .nii.gz, .nrrd or .mha")->type_name(value::file)->required();
  verb->add_option("--series", a->series, "series to take: its UID, number or role (stiffness, magnitude, ...)");
  verb->callback([&context, a] {
    context.action = [&context, a] {
      const Progress progress = context.progress();
      image::ScalarVolume volume;
      std::vector<std::string> warnings;
      Diagnostics diagnostics;
      Json j;
      std::ostringstream text;
      if (std::filesystem::is_regular_file(a->in) && image::isVolumeFile(a->in)) {
        if (!a->series.empty()) warnings.push_back("a volume file holds no series: --series was not used");
        volume = image::readVolume(a->in, &diagnostics);
        for (const std::string& w : diagnostics.texts(Severity::Warning)) warnings.push_back(w);
      } else {
        const dicom::ScanResult scan = dicom::scan(a->in, progress.part(0.0, 0.5));
        const dicom::Series& series = chosen(scan, a->series);
        volume = read(series, diagnostics, progress.part(0.5, 1.0));
        warnings = series.warnings;
        const std::vector<std::string> more = diagnostics.texts();
        warnings.insert(warnings.end(), more.begin(), more.end());
        diagnostics.add(series.diagnostics);
        j["series"] = {{"uid", series.uid},
                       {"number", series.number},
                       {"role", name(series.role)},
                       {"description", series.description}};
        j["series_found"] = scan.series.size();
        text << "series " << shown(series, false) << " taken of " << scan.series.size() << " found\n";
      }
      refuseIfStrict(context, diagnostics, warnings);
      image::writeVolume(a->out, volume);
      const image::Grid& g = volume.grid;
      j["slices"] = g.size.z();
      j["rows"] = g.size.y();
      j["columns"] = g.size.x();
      j["spacing_mm"] = {g.spacing_mm.x(), g.spacing_mm.y(), g.spacing_mm.z()};
      j["origin_lps_mm"] = {g.origin_lps_mm.x(), g.origin_lps_mm.y(), g.origin_lps_mm.z()};
      j["warnings"] = warnings;
      j["diagnostics"] = diagnosticsJson(diagnostics, warnings);
      text << g.size.x() << " x " << g.size.y() << " x " << g.size.z() << " voxels of (" << g.spacing_mm.transpose()
           << ") mm written to " << a->out.string() << "\n";
      for (const std::string& w : warnings) text << "warning: " << w << "\n";
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
