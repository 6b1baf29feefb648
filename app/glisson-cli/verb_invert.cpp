// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "diagnostics_json.h"
#include "pipeline/invert.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct InvertArguments {
  pipeline::InvertRequest request;
  std::vector<double> encodings;
  std::string filter = "auto", unwrap = "auto";
  double radiansPerUnit = 0.0;
};

Json statistics(const elastography::Statistics& s) {
  return {
      {"n", s.n}, {"mean_kPa", orNull(s.mean_kPa)}, {"median_kPa", orNull(s.median_kPa)}, {"sd_kPa", orNull(s.sd_kPa)}};
}

const char* nameOf(inversion::BulkFilter filter) {
  switch (filter) {
    case inversion::BulkFilter::Auto: return "auto";
    case inversion::BulkFilter::None: return "none";
    case inversion::BulkFilter::HighPass: return "highpass";
    case inversion::BulkFilter::Curl: return "curl";
  }
  return "";
}

/// The request with what was given in words and lists.
pipeline::InvertRequest requestOf(const InvertArguments& a) {
  pipeline::InvertRequest request = a.request;
  if (a.encodings.size() % 3 != 0) throw BadInput("an encoding vector has three numbers: x y z");
  for (std::size_t e = 0; e + 2 < a.encodings.size(); e += 3)
    request.phases.encodings_lps.emplace_back(a.encodings[e], a.encodings[e + 1], a.encodings[e + 2]);
  if (a.radiansPerUnit > 0.0) request.phases.radiansPerUnit = a.radiansPerUnit;
  request.unwrapping = a.unwrap == "temporal"  ? inversion::Unwrapping::Temporal
                       : a.unwrap == "quality" ? inversion::Unwrapping::Quality
                                               : inversion::Unwrapping::Auto;
  request.options.filter = a.filter == "curl"   ? inversion::BulkFilter::Curl
                           : a.filter == "none" ? inversion::BulkFilter::None
                           : a.filter == "auto" ? inversion::BulkFilter::Auto
                                                : inversion::BulkFilter::HighPass;
  return request;
}

int invert(const InvertArguments& a, const Context& context) {
  const pipeline::InvertedPhases inverted = pipeline::invertPhases(requestOf(a), context.progress());
  const inversion::Inversion& r = inverted.inversion;
  Json j = {{"frequency_Hz", r.used.frequency_Hz}, {"offsets", inverted.offsets}, {"phase_scale", inverted.scale}};
  for (const pipeline::WaveQuality& d : inverted.directions)
    j["directions"].push_back(
        {{"noise_rad", d.noise_rad}, {"jumping_fraction", d.jumping}, {"unwrapped_in_space", d.spatiallyUnwrapped}});
  j["inversion"] = {{"dimensions", r.used.dimensions},      {"method", "laplacian"},
                    {"filter", nameOf(r.used.filter)},      {"window_mm", r.used.window_mm},
                    {"averaging_mm", r.used.averaging_mm},  {"cutoff_mm", r.used.cutoff_mm},
                    {"density_kg_m3", r.used.density_kg_m3}};
  j["voxels_resolved"] = r.resolved;
  j["confidence_threshold"] = a.request.confidence;
  j["confidence_means"] = "probability-that-noise-moves-less-than-19-percent";
  j["quantity"] = "shear";
  j["stiffness"] = statistics(inverted.stiffness);
  j["storage"] = statistics(inverted.storage);
  j["loss"] = statistics(inverted.loss);
  j["shear_stiffness"] = statistics(inverted.shear);
  j["spread"] = statistics(inverted.spread);
  j["stiffness"]["is"] = "|G*|, magnitude of the complex shear modulus";
  j["shear_stiffness"]["is"] = "density x wave speed squared";
  const std::vector<std::string>& warnings = inverted.warnings;
  refuseIfStrict(context, inverted.diagnostics, warnings);
  j["warnings"] = warnings;
  j["diagnostics"] = diagnosticsJson(inverted.diagnostics, warnings);
  j["files"] = Json::array();
  if (!context.output.empty()) {
    for (const auto& file : pipeline::writeInversion(context.output, r)) j["files"].push_back(file.string());
    j["files"].push_back((context.output / "invert.json").string());
    writeAtomically(context.output / "invert.json", j.dump(1) + "\n");
  }
  std::ostringstream text;
  for (const char* key : {"stiffness", "storage", "loss", "shear_stiffness"})
    text << key << "  " << j[key].dump() << "\n";
  for (const std::string& w : warnings) text << "warning: " << w << "\n";
  for (const auto& f : j["files"]) text << "written " << f.get<std::string>() << "\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addInvert(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("invert", "raw phase images of an elastography acquisition to stiffness");
  auto a = std::make_shared<InvertArguments>();
  verb->add_option("--phase", a->request.phases.paths,
                   "phase images: volumes in order of direction and time, or folders")
      ->type_name(value::folderOrVolume)
      ->required();
  verb->add_option("--frequency", a->request.options.frequency_Hz, "of the vibration, Hz; DICOM files may tell it")
      ->check(CLI::PositiveNumber);
  verb->add_option("--directions", a->request.phases.directions, "motion-encoding directions in plain volumes")
      ->check(CLI::Range(1, 12));
  verb->add_option("--encoding", a->encodings, "x y z (LPS) of every direction, for the curl")->delimiter(',');
  verb->add_option("--radians-per-unit", a->radiansPerUnit, "of stored values, where they do not tell");
  verb->add_option("--mask", a->request.mask, "voxels with signal; else found from the noise in time")
      ->type_name(value::mask);
  verb->add_option("--filter", a->filter, "what takes compression away; auto is highpass")
      ->check(CLI::IsMember({"auto", "highpass", "curl", "none"}));
  verb->add_option("--unwrap", a->unwrap, "phase unwrapping")->check(CLI::IsMember({"auto", "temporal", "quality"}));
  verb->add_option("--dimensions", a->request.options.dimensions,
                   "2: slice by slice, 3: in space, 0: by slice distance")
      ->check(CLI::IsMember({0, 2, 3}));
  verb->add_option("--window", a->request.options.window_mm, "radius of the window, mm; 0: from the frequency");
  verb->add_option("--averaging", a->request.options.averaging_mm, "radius of pooling, mm; 0: from the frequency");
  verb->add_option("--cutoff", a->request.options.cutoff_mm,
                   "wavelength that the high-pass halves, mm; 0: from the frequency");
  verb->add_option("--density", a->request.options.density_kg_m3, "kg/m3")->check(CLI::PositiveNumber);
  verb->add_option("--confidence", a->request.confidence, "least confidence of voxels in the statistics")
      ->check(CLI::Range(0.0, 1.0));
  addSlicerXml(*verb, {"Invert wave images", {PathKind::Folder}});
  verb->callback([&context, a] { context.action = [&context, a] { return invert(*a, context); }; });
}

}  // namespace glisson::cli
