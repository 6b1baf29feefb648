#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "elastography/statistics.h"
#include "image/io.h"
#include "pipeline/phases.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
  pipeline::PhaseRequest phases;
  std::vector<double> encodings;
  inversion::InversionOptions options;
  std::filesystem::path mask;
  std::string filter = "auto", method = "auto", unwrap = "auto";
  double radiansPerUnit = 0.0, confidence = defaults::confidenceThreshold;
};

/// Of the voxels that have a modulus and are confident enough.
Json statistics(const inversion::Inversion& r, const image::ScalarVolume& values, double threshold) {
  std::vector<double> list;
  for (std::size_t v = 0; v < values.values.size(); ++v)
    if (std::isfinite(values.values[v]) && r.confidence.values[v] >= static_cast<float>(threshold))
      list.push_back(static_cast<double>(values.values[v]));
  const elastography::Statistics s =
      elastography::statisticsOf(std::move(list), values.grid.spacing_mm.head<2>().prod());
  const auto orNull = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  return {
      {"n", s.n}, {"mean_kPa", orNull(s.mean_kPa)}, {"median_kPa", orNull(s.median_kPa)}, {"sd_kPa", orNull(s.sd_kPa)}};
}

const char* nameOf(inversion::BulkFilter filter) {
  switch (filter) {
    case inversion::BulkFilter::Auto: return "auto";
    case inversion::BulkFilter::None: return "none";
    case inversion::BulkFilter::Local: return "local";
    case inversion::BulkFilter::HighPass: return "highpass";
    case inversion::BulkFilter::Curl: return "curl";
  }
  return "";
}

/// What makes statistics of few voxels doubtful, in words; nothing where there are enough.
std::optional<std::string> fewConfident(std::size_t confident, std::size_t resolved, double threshold,
                                        double noise_rad) {
  if (confident >= 50 && 20 * confident >= resolved) return {};
  std::ostringstream text;
  text.precision(2);
  text << (confident == 0 ? "no voxel" : "only " + std::to_string(confident)) << " of " << resolved
       << " voxels with a modulus reach a confidence of " << threshold
       << ": the waves there do not follow the wave equation of one stiffness well enough";
  if (noise_rad > 0.2)
    text << "; the phase noise is " << noise_rad << " rad, and from 0.1 rad on it spoils a wave of 1 rad";
  text
      << "; give a mask of the organ (--mask), another filter (--filter, --cutoff), or read a lower --confidence as an "
         "order of magnitude only";
  return text.str();
}

int invert(Arguments a, const Context& context) {
  const Progress progress = context.progress();
  if (a.encodings.size() % 3 != 0) throw BadInput("an encoding vector has three numbers: x y z");
  for (std::size_t e = 0; e + 2 < a.encodings.size(); e += 3)
    a.phases.encodings_lps.emplace_back(a.encodings[e], a.encodings[e + 1], a.encodings[e + 2]);
  if (a.radiansPerUnit > 0.0) a.phases.radiansPerUnit = a.radiansPerUnit;
  const pipeline::LoadedPhases phases = pipeline::loadPhases(a.phases, progress.part(0.0, 0.3));
  if (a.options.frequency_Hz <= 0.0) {
    if (!phases.frequency_Hz) throw BadInput("the files do not tell the vibration frequency; give it with --frequency");
    a.options.frequency_Hz = *phases.frequency_Hz;
  }
  inversion::WaveOptions waveOptions;
  waveOptions.unwrapping = a.unwrap == "temporal"  ? inversion::Unwrapping::Temporal
                           : a.unwrap == "quality" ? inversion::Unwrapping::Quality
                                                   : inversion::Unwrapping::Auto;
  Diagnostics diagnostics;
  if (!a.mask.empty()) waveOptions.mask = image::readMask(a.mask, 0, &diagnostics);
  a.options.filter = a.filter == "curl"   ? inversion::BulkFilter::Curl
                     : a.filter == "none"  ? inversion::BulkFilter::None
                     : a.filter == "local" ? inversion::BulkFilter::Local
                     : a.filter == "auto"  ? inversion::BulkFilter::Auto
                                           : inversion::BulkFilter::HighPass;
  a.options.method = a.method == "local-waves" ? inversion::Method::LocalWaves
                     : a.method == "laplacian" ? inversion::Method::Laplacian
                                               : inversion::Method::Auto;
  inversion::Waves waves = inversion::firstHarmonic(phases.directions, waveOptions, progress.part(0.3, 0.5));
  Json j = {{"frequency_Hz", a.options.frequency_Hz},
            {"offsets", phases.directions.front().offsets_rad.size()},
            {"phase_scale", phases.scale}};
  for (const auto& d : waves.directions)
    j["directions"].push_back(
        {{"noise_rad", d.noise_rad}, {"jumping_fraction", d.jumping}, {"unwrapped_in_space", d.spatiallyUnwrapped}});
  double noise_rad = 0.0;
  for (const auto& d : waves.directions) noise_rad = std::max(noise_rad, d.noise_rad);
  const inversion::Inversion r = inversion::invert(std::move(waves), a.options, progress.part(0.5, 1.0));
  j["inversion"] = {{"dimensions", r.used.dimensions},
                    {"method", r.used.method == inversion::Method::LocalWaves ? "local-waves" : "laplacian"},
                    {"filter", nameOf(r.used.filter)},
                    {"window_mm", r.used.window_mm},   {"averaging_mm", r.used.averaging_mm},
                    {"cutoff_mm", r.used.cutoff_mm},   {"density_kg_m3", r.used.density_kg_m3}};
  j["voxels_resolved"] = r.resolved;
  j["confidence_threshold"] = a.confidence;
  j["confidence_means"] =
      r.confidenceMeans == inversion::ConfidenceMeaning::ProbabilityWithin ? "probability-within-19-percent" : "explained";
  if (r.used.method == inversion::Method::LocalWaves) j["correlated_voxels"] = r.correlatedVoxels;
  j["quantity"] = "shear";
  j["stiffness"] = statistics(r, r.magnitude_kPa, a.confidence);
  j["storage"] = statistics(r, r.storage_kPa, a.confidence);
  j["loss"] = statistics(r, r.loss_kPa, a.confidence);
  j["shear_stiffness"] = statistics(r, r.shear_kPa, a.confidence);
  if (!r.spread_kPa.values.empty()) j["spread"] = statistics(r, r.spread_kPa, a.confidence);
  j["stiffness"]["is"] = "|G*|, magnitude of the complex shear modulus";
  j["shear_stiffness"]["is"] = "density x wave speed squared";
  std::vector<std::string> warnings = phases.warnings;
  for (const std::string& w : diagnostics.texts(Severity::Warning)) warnings.push_back(w);
  warnings.insert(warnings.end(), r.warnings.begin(), r.warnings.end());
  if (const auto few = fewConfident(j["stiffness"]["n"].get<std::size_t>(), r.resolved, a.confidence, noise_rad))
    warnings.push_back(*few);
  refuseIfStrict(context, diagnostics, warnings);
  j["warnings"] = warnings;
  j["diagnostics"] = diagnosticsJson(diagnostics, warnings);
  j["files"] = Json::array();
  if (!context.output.empty()) {
    for (const auto& file : pipeline::writeInversion(context.output, r)) j["files"].push_back(file.string());
    j["files"].push_back((context.output / "invert.json").string());
    std::ofstream(context.output / "invert.json") << j.dump(1) << "\n";
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
  auto a = std::make_shared<Arguments>();
  verb->add_option("--phase", a->phases.paths, "phase images: volumes in order of direction and time, or folders")
      ->type_name(value::folderOrVolume)
      ->required();
  verb->add_option("--frequency", a->options.frequency_Hz, "of the vibration, Hz; DICOM files may tell it")
      ->check(CLI::PositiveNumber);
  verb->add_option("--directions", a->phases.directions, "motion-encoding directions in plain volumes")
      ->check(CLI::Range(1, 12));
  verb->add_option("--encoding", a->encodings, "x y z (LPS) of every direction, for the curl")->delimiter(',');
  verb->add_option("--radians-per-unit", a->radiansPerUnit, "of stored values, where they do not tell");
  verb->add_option("--mask", a->mask, "voxels with signal; else found from the noise in time")
      ->type_name(value::mask);
  verb->add_option("--method", a->method, "auto is laplacian; local-waves slice by slice only")
      ->check(CLI::IsMember({"auto", "local-waves", "laplacian"}));
  verb->add_option("--filter", a->filter, "what takes compression away; auto: local with local waves, highpass with the laplacian")
      ->check(CLI::IsMember({"auto", "local", "highpass", "curl", "none"}));
  verb->add_option("--unwrap", a->unwrap, "phase unwrapping")->check(CLI::IsMember({"auto", "temporal", "quality"}));
  verb->add_option("--dimensions", a->options.dimensions, "2: slice by slice, 3: in space, 0: by slice distance")
      ->check(CLI::IsMember({0, 2, 3}));
  verb->add_option("--window", a->options.window_mm, "radius of the window, mm; 0: from the frequency");
  verb->add_option("--averaging", a->options.averaging_mm, "radius of pooling, mm; 0: from the frequency");
  verb->add_option("--cutoff", a->options.cutoff_mm, "wavelength that the high-pass halves, mm; 0: from the frequency");
  verb->add_option("--density", a->options.density_kg_m3, "kg/m3")->check(CLI::PositiveNumber);
  verb->add_option("--confidence", a->confidence, "least confidence of voxels in the statistics")
      ->check(CLI::Range(0.0, 1.0));
  addSlicerXml(*verb, {"Invert wave images", {PathKind::Folder}});
  verb->callback([&context, a] { context.action = [&context, a] { return invert(*a, context); }; });
}

}  // namespace glisson::cli
