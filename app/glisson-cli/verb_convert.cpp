#include <sstream>

#include "base/error.h"
#include "image/io.h"
#include "pipeline/sources.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
  std::filesystem::path in, out;
  std::string series;
};

pipeline::AnatomicalImage load(const Arguments& a, const Progress& progress) {
  if (a.series.empty()) return pipeline::loadImage(a.in, progress);
  const dicom::ScanResult scan = dicom::scan(a.in, progress.part(0.0, 0.5));
  for (const dicom::Series& s : scan.series)
    if (s.uid == a.series || name(s.role) == a.series || std::to_string(s.number) == a.series)
      return {dicom::readSeries(s, progress.part(0.5, 1.0)),
              s.frameOfReferenceUid,
              s.patientKey,
              s.studyDate,
              s.warnings,
              {}};
  throw BadInput("no series has the UID, number or role '" + a.series + "'; list them with: glisson-cli scan");
}

}  // namespace

void addConvert(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("convert", "a series or volume to NIfTI, NRRD or MetaImage, geometry kept");
  auto a = std::make_shared<Arguments>();
  verb->add_option("in", a->in, "DICOM folder or file, or a volume")->required();
  verb->add_option("out", a->out, "file to write: .nii, .nii.gz, .nrrd or .mha")->required();
  verb->add_option("--series", a->series, "series to take: its UID, number or role (stiffness, magnitude, ...)");
  verb->callback([&context, a] {
    context.action = [&context, a] {
      const pipeline::AnatomicalImage in = load(*a, context.progress());
      image::writeVolume(a->out, in.volume);
      const image::Grid& g = in.volume.grid;
      Json j;
      j["slices"] = g.size.z();
      j["rows"] = g.size.y();
      j["columns"] = g.size.x();
      j["spacing_mm"] = {g.spacing_mm.x(), g.spacing_mm.y(), g.spacing_mm.z()};
      j["origin_lps_mm"] = {g.origin_lps_mm.x(), g.origin_lps_mm.y(), g.origin_lps_mm.z()};
      j["warnings"] = in.warnings;
      std::ostringstream text;
      text << g.size.x() << " x " << g.size.y() << " x " << g.size.z() << " voxels of (" << g.spacing_mm.transpose()
           << ") mm written to " << a->out.string() << "\n";
      for (const std::string& w : in.warnings) text << "warning: " << w << "\n";
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
