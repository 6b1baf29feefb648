// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/invert.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "image/io.h"

namespace glisson::pipeline {
namespace {

/// Of the voxels that have a modulus and are confident enough.
elastography::Statistics statisticsOver(const inversion::Inversion& r, const image::ScalarVolume& values,
                                        double threshold) {
  std::vector<double> list;
  for (std::size_t v = 0; v < values.values.size(); ++v)
    if (std::isfinite(values.values[v]) && r.confidence.values[v] >= static_cast<float>(threshold))
      list.push_back(static_cast<double>(values.values[v]));
  return elastography::statisticsOf(std::move(list), values.grid.spacing_mm.head<2>().prod());
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

void addStatistics(double threshold, InvertedPhases& out) {
  const inversion::Inversion& r = out.inversion;
  out.stiffness = statisticsOver(r, r.magnitude_kPa, threshold);
  out.storage = statisticsOver(r, r.storage_kPa, threshold);
  out.loss = statisticsOver(r, r.loss_kPa, threshold);
  out.shear = statisticsOver(r, r.shear_kPa, threshold);
  out.spread = statisticsOver(r, r.spread_kPa, threshold);
}

}  // namespace

InvertedPhases invertPhases(const InvertRequest& request, const Progress& progress) {
  const LoadedPhases phases = loadPhases(request.phases, progress.part(0.0, 0.3));
  inversion::InversionOptions options = request.options;
  if (options.frequency_Hz <= 0.0) {
    if (!phases.frequency_Hz) throw BadInput("the files do not tell the vibration frequency; give it with --frequency");
    options.frequency_Hz = *phases.frequency_Hz;
  }
  InvertedPhases out;
  inversion::WaveOptions waveOptions;
  waveOptions.unwrapping = request.unwrapping;
  if (!request.mask.empty()) waveOptions.mask = image::readMask(request.mask, 0, &out.diagnostics);
  inversion::Waves waves = inversion::firstHarmonic(phases.directions, waveOptions, progress.part(0.3, 0.5));
  out.offsets = phases.directions.front().offsets_rad.size();
  out.scale = phases.scale;
  double noise_rad = 0.0;
  for (const auto& d : waves.directions) {
    out.directions.push_back({d.noise_rad, d.jumping, d.spatiallyUnwrapped});
    noise_rad = std::max(noise_rad, d.noise_rad);
  }
  out.inversion = inversion::invert(std::move(waves), options, progress.part(0.5, 1.0));
  addStatistics(request.confidence, out);
  out.warnings = phases.warnings;
  for (const std::vector<std::string>& more : {out.diagnostics.texts(Severity::Warning), out.inversion.warnings})
    out.warnings.insert(out.warnings.end(), more.begin(), more.end());
  if (const auto few = fewConfident(out.stiffness.n, out.inversion.resolved, request.confidence, noise_rad))
    out.warnings.push_back(*few);
  return out;
}

}  // namespace glisson::pipeline
