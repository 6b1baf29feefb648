// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "pipeline/outline_proposal.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct ProposeArguments {
  std::filesystem::path image;
  std::vector<double> seed;
  bool index = false;
  roi::ProposalOptions options;
};

int propose(const ProposeArguments& a, const Context& context) {
  if (context.output.empty()) throw BadInput("say where the proposal goes: --output roi.json, or a mask file");
  const Eigen::Vector3d seed(a.seed[0], a.seed[1], a.seed[2]);
  const pipeline::OutlineProposal proposed =
      pipeline::proposeOutline(a.image, {seed, a.index}, a.options, context.progress());
  refuseIfStrict(context, proposed.diagnostics, proposed.warnings);
  const roi::Proposal& p = proposed.proposal;
  const Eigen::Vector3d& seed_lps = proposed.seed_lps_mm;
  const std::size_t polygons = pipeline::writeProposal(context.output, proposed);
  Json j = {{"volume_mL", p.volume_mL}, {"intensities", {p.low, p.high}}, {"touches_border", p.touchesBorder}};
  j["seed_lps_mm"] = {seed_lps.x(), seed_lps.y(), seed_lps.z()};
  if (polygons > 0) j["polygons"] = polygons;
  j["warnings"] = proposed.warnings;
  j["diagnostics"] = diagnosticsJson(proposed.diagnostics, proposed.warnings);
  j["files"] = {context.output.string()};
  std::ostringstream text;
  text << p.volume_mL << " mL of intensities " << p.low << " to " << p.high << " written to " << context.output.string()
       << "\n";
  for (const std::string& w : proposed.warnings) text << "warning: " << w << "\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addPropose(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("propose", "a first outline of an organ from one point inside it, to correct");
  auto a = std::make_shared<ProposeArguments>();
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
