// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/phases.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "dicom/series.h"
#include "image/io.h"
#include "pipeline/file_names.h"

namespace glisson::pipeline {
namespace {

std::vector<std::filesystem::path> volumesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && image::isVolumeFile(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Direction, then time step.
using Ordered = std::map<std::pair<int, int>, image::ScalarVolume>;

void readDicom(const std::filesystem::path& path, Ordered& found, LoadedPhases& out, const Progress& progress) {
  const dicom::ScanResult scan = dicom::scan(path, progress);
  const FileNames names(scan);
  for (const dicom::Series& s : scan.series) {
    if (s.role != dicom::SeriesRole::Phase || s.temporalIndex < 0) continue;
    progress.check();
    if (!found.emplace(std::pair(std::max(s.encodingDirection, 0), s.temporalIndex), dicom::readSeries(s)).second)
      throw BadInput("two phase images of one direction and time step were found in '" + path.filename().string() +
                     "'; give the folder of one acquisition");
    if (s.vibration_Hz) out.frequency_Hz = s.vibration_Hz;
    for (const std::string& shown : s.warnings) {
      // That it is one of many volumes is what makes a raw acquisition: said once, with the count, below.
      if (s.encodingDirection >= 0 && std::any_of(s.diagnostics.begin(), s.diagnostics.end(), [&](const Diagnostic& d) {
            return d.code == DiagnosticCode::VolumeOfSeries && d.text() == shown;
          }))
        continue;
      const std::string warning = names.hiddenIn(shown);
      if (std::find(out.warnings.begin(), out.warnings.end(), warning) == out.warnings.end())
        out.warnings.push_back(warning);
    }
  }
  if (found.size() > 1)
    out.warnings.push_back(std::to_string(found.size()) +
                           " phase volumes were told apart by their encoding direction and time step");
  if (found.empty())
    throw BadInput("'" + path.filename().string() +
                   "' holds no raw phase images whose time step is known; convert them to volumes, in order of "
                   "direction and time, and give these");
}

}  // namespace

LoadedPhases loadPhases(const PhaseRequest& request, const Progress& progress) {
  LoadedPhases out;
  std::vector<image::ScalarVolume> plain;
  Ordered ordered;
  for (std::size_t p = 0; p < request.paths.size(); ++p) {
    const std::filesystem::path& path = request.paths[p];
    progress.report(static_cast<double>(p) / static_cast<double>(request.paths.size()), "reading phase images");
    if (!std::filesystem::exists(path)) throw BadInput("there is no '" + path.filename().string() + "'");
    const bool folder = std::filesystem::is_directory(path);
    if (!folder && image::isVolumeFile(path)) {
      plain.push_back(image::readVolume(path));
    } else if (const auto files = folder ? volumesIn(path) : std::vector<std::filesystem::path>{}; !files.empty()) {
      for (const auto& file : files) plain.push_back(image::readVolume(file));
    } else {
      readDicom(path, ordered, out, progress);
    }
  }
  if (!plain.empty() && !ordered.empty())
    throw BadInput("the phase images are DICOM files and plain volumes; give one kind");
  if (!ordered.empty()) {
    int last = -1;
    for (auto& [key, volume] : ordered) {
      if (key.first != last) out.directions.emplace_back();
      last = key.first;
      if (key.second != static_cast<int>(out.directions.back().offsets_rad.size()))
        throw BadInput("time step " + std::to_string(out.directions.back().offsets_rad.size() + 1) + " of direction " +
                       std::to_string(key.first + 1) + " is missing");
      out.directions.back().offsets_rad.push_back(std::move(volume));
    }
  } else {
    const auto directions = static_cast<std::size_t>(std::max(request.directions, 1));
    if (plain.empty() || plain.size() % directions != 0)
      throw BadInput(std::to_string(plain.size()) + " phase volumes cannot be parted into " +
                     std::to_string(directions) + " directions of equally many offsets");
    const std::size_t offsets = plain.size() / directions;
    for (std::size_t v = 0; v < plain.size(); ++v) {
      if (v % offsets == 0) out.directions.emplace_back();
      out.directions.back().offsets_rad.push_back(std::move(plain[v]));
    }
  }
  if (!request.encodings_lps.empty() && request.encodings_lps.size() != out.directions.size())
    throw BadInput(std::to_string(request.encodings_lps.size()) + " encoding vectors for " +
                   std::to_string(out.directions.size()) + " directions; give one for each");
  for (std::size_t d = 0; d < request.encodings_lps.size(); ++d)
    out.directions[d].encoding_lps = request.encodings_lps[d];

  inversion::PhaseScale scale{request.radiansPerUnit.value_or(1.0), 0.0, "as given"};
  if (!request.radiansPerUnit) {
    std::vector<image::ScalarVolume> all;
    for (const auto& direction : out.directions)
      all.insert(all.end(), direction.offsets_rad.begin(), direction.offsets_rad.end());
    scale = inversion::phaseScale(all);
  }
  out.scale = scale.reason;
  for (auto& direction : out.directions)
    for (auto& volume : direction.offsets_rad) inversion::toRadians(volume, scale);
  progress.report(1.0, "phase images read");
  return out;
}

std::vector<std::filesystem::path> writeInversion(const std::filesystem::path& folder,
                                                  const inversion::Inversion& inversion) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw BadInput("the folder '" + folder.filename().string() + "' cannot be made: " + failed.message());
  std::vector<std::filesystem::path> files;
  const auto write = [&](const std::string& name, image::ScalarVolume volume) {
    for (float& v : volume.values)
      if (!std::isfinite(v)) v = 0.0F;
    files.push_back(folder / (name + ".nii.gz"));
    image::writeVolume(files.back(), volume);
  };
  write("stiffness", inversion.magnitude_kPa);
  write("storage", inversion.storage_kPa);
  write("loss", inversion.loss_kPa);
  write("shear_stiffness", inversion.shear_kPa);
  write("confidence", inversion.confidence);
  if (!inversion.spread_kPa.values.empty()) write("spread", inversion.spread_kPa);
  for (std::size_t w = 0; w < inversion.waves.size(); ++w) {
    const inversion::ComplexVolume& wave = inversion.waves[w];
    image::ScalarVolume real(wave.grid), imaginary(wave.grid);
    for (std::size_t v = 0; v < wave.values.size(); ++v) {
      real.values[v] = wave.values[v].real();
      imaginary.values[v] = wave.values[v].imag();
    }
    write("wave_" + std::to_string(w + 1) + "_real", std::move(real));
    write("wave_" + std::to_string(w + 1) + "_imag", std::move(imaginary));
  }
  return files;
}

}  // namespace glisson::pipeline
