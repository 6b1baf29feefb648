#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "image/io.h"
#include "pipeline/sources.h"
#include "roi/contour_io.h"
#include "roi/polygon.h"
#include "roi/propose.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
  std::filesystem::path image;
  std::vector<double> seed;
  bool index = false;
  roi::ProposalOptions options;
};

int propose(const Arguments& a, const Context& context) {
  if (context.output.empty()) throw BadInput("say where the proposal goes: --output roi.json, or a mask file");
  const Progress progress = context.progress();
  const pipeline::AnatomicalImage in = pipeline::loadImage(a.image, progress.part(0.0, 0.3));
  Eigen::Vector3d seed_lps(a.seed[0], a.seed[1], a.seed[2]);
  if (a.index) seed_lps = in.volume.grid.indexToLps(seed_lps);
  const roi::Proposal p = roi::propose(in.volume, seed_lps, a.options, progress.part(0.3, 1.0));
  std::vector<std::string> warnings = in.warnings;
  warnings.insert(warnings.end(), p.notes.begin(), p.notes.end());
  Diagnostics diagnostics = in.diagnostics;
  Diagnostics own;
  own.add(DiagnosticCode::ProposalOnly);
  if (p.touchesBorder) own.add(DiagnosticCode::ProposalAtBorder);
  diagnostics.add(own);
  refuseIfStrict(context, diagnostics, warnings);
  for (const std::string& w : own.texts()) warnings.push_back(w);
  std::size_t polygons = 0;
  if (image::isVolumeFile(context.output)) {
    image::writeVolume(context.output, p.mask);
  } else {
    roi::ContourStack contours = roi::contoursOf(p.mask);
    contours.frameOfReferenceUid = in.frameOfReferenceUid;
    // Half a pixel: the stairs of the mask go, its area stays.
    for (roi::Polygon& polygon : contours.polygons)
      polygon = roi::simplified(polygon, 0.5 * in.volume.grid.spacing_mm.head<2>().minCoeff());
    polygons = contours.polygons.size();
    roi::writeContours(context.output, contours);
  }
  Json j = {{"volume_mL", p.volume_mL}, {"intensities", {p.low, p.high}}, {"touches_border", p.touchesBorder}};
  j["seed_lps_mm"] = {seed_lps.x(), seed_lps.y(), seed_lps.z()};
  if (polygons > 0) j["polygons"] = polygons;
  j["warnings"] = warnings;
  j["diagnostics"] = diagnosticsJson(diagnostics, warnings);
  j["files"] = {context.output.string()};
  std::ostringstream text;
  text << p.volume_mL << " mL of intensities " << p.low << " to " << p.high << " written to " << context.output.string()
       << "\n";
  for (const std::string& w : warnings) text << "warning: " << w << "\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addPropose(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("propose", "a first outline of an organ from one point inside it, to correct");
  auto a = std::make_shared<Arguments>();
  verb->add_option("--image", a->image, "DICOM folder, or a volume")->type_name(value::folderOrVolume)->required();
  verb->add_option("--seed", a->seed, "x,y,z inside the organ, LPS mm")
      ->type_name(value::point)
      ->required()
      ->expected(3)
      ->delimiter(',');
  verb->add_flag("--index", a->index, "the seed is a voxel index, not millimetres");
  verb->add_option("--spread", a->options.spread, "intensities accepted, in robust SDs of the surroundings")
      ->check(CLI::PositiveNumber);
  verb->add_option("--neck", a->options.neck_mm, "bridges thinner than twice this are cut, mm")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--closing", a->options.closing_mm, "gaps narrower than twice this are closed, mm")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--least", a->options.least_mL, "of an organ, mL: what is smaller is refused")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--most", a->options.most_mL, "of an organ, mL: what is larger has leaked and is refused")
      ->check(CLI::PositiveNumber);
  addSlicerXml(*verb, {"Propose an outline", {PathKind::File, PathKind::Mask}});
  verb->callback([&context, a] { context.action = [&context, a] { return propose(*a, context); }; });
}

}  // namespace glisson::cli
