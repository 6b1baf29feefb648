// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/error.h"
#include "image/resample.h"
#include "pipeline/detail/export_case.h"
#include "pipeline/replay.h"
#include "roi/polygon.h"

namespace glisson::pipeline::detail {

ExportCase::ExportCase(const ExportRequest& request, const Progress& progress)
    : request_(request), progress_(progress) {
  std::filesystem::path file = request.source;
  if (std::filesystem::is_directory(file)) {
    runFolder_ = file;
    file /= "scene.json";
    if (!std::filesystem::exists(file))
      throw BadInput("the folder holds no scene.json: give a scene file, or the folder that a run has written");
  }
  scene_ = readScene(file);
  if (const auto record = runFolder_ / "run.json"; !runFolder_.empty() && std::filesystem::exists(record))
    for (const std::string& name : filesOfAnotherRun(record))
      warn("'" + name + "' in the run's folder is not the file that its run.json was written with");
  std::error_code failed;
  std::filesystem::create_directories(request.output, failed);
  if (failed || !std::filesystem::is_directory(request.output))
    throw BadInput("the output folder cannot be made; choose another with --output");
}

const dicom::Series& ExportCase::series(const std::filesystem::path& path, dicom::SeriesRole role, const char* what,
                                        std::optional<dicom::Series>& kept) {
  if (kept) return *kept;
  if (scene_.geometry.kind != GeometrySpec::Kind::Patient || path.empty())
    throw BadInput(std::string("this format refers to DICOM images, and the scene has no ") + what);
  dicom::ScanResult scan = dicom::scan(path, progress_);
  dicom::applyRoles(scan, scene_.geometry.roles);
  if (scan.series.empty())
    throw BadInput(std::string("this format refers to DICOM images, and the scene's ") + what + " is no DICOM series");
  Diagnostics said;
  kept = seriesFor(scan, role, roi().names, said);
  if (kept->error) throw BadInput("the series cannot be used as a volume: " + *kept->error);
  return *kept;
}

const dicom::Series& ExportCase::mri() {
  return series(scene_.geometry.mri, dicom::SeriesRole::Anatomical, "MRI", mri_);
}

const dicom::Series& ExportCase::mre() {
  return series(scene_.geometry.mre, dicom::SeriesRole::Stiffness, "elastogram", mre_);
}

const elastography::StiffnessMap& ExportCase::stiffness() {
  if (stiffness_) return *stiffness_;
  if (scene_.geometry.mre.empty()) throw BadInput("this format needs an elastogram, and the scene has none");
  const GeometrySpec& g = scene_.geometry;
  MapMeaning meaning{g.mreQuantity, g.mreUnit, g.roles};
  meaning.confidenceScale = g.mreConfidenceScale;
  if (g.kind == GeometrySpec::Kind::Patient) meaning.outlined = roi().names;
  LoadedStiffness loaded = loadStiffness(g.mre, meaning, progress_);
  for (const std::string& w : loaded.warnings) warn(w);
  stiffness_ = request_.quantity ? elastography::toQuantity(loaded.map, *request_.quantity, scene_.setup.poisson)
                                 : std::move(loaded.map);
  return *stiffness_;
}

const LoadedRoi& ExportCase::roi() {
  if (roi_) return *roi_;
  const GeometrySpec& g = scene_.geometry;
  if (g.kind == GeometrySpec::Kind::Box)
    throw BadInput("this format needs a region of interest, and the scene is a box");
  roi_ = loadRoi(g.kind == GeometrySpec::Kind::Mask ? g.file : g.roi, g.roiName, g.label, progress_);
  if (g.kind == GeometrySpec::Kind::Patient) {
    const AnatomicalImage mri = loadImage(g.mri, progress_, g.roles, roi_->names);
    checkOutlines(*roi_, mri.volume.grid);
    for (const std::string& w : roi_->warnings) warn(w);
    for (const std::string& w : checkRoi(*roi_, &mri, nullptr, g.overrideChecks)) warn(w);
    for (const std::string& w : mri.diagnostics.texts(Severity::Warning)) warn(w);
    for (const std::string& w : doubtsAboutOutline(*roi_, &mri, nullptr).texts(Severity::Warning)) warn(w);
    mriGrid_ = mri.volume.grid;
    if (const auto completed = completeOutlines(*roi_, *mriGrid_)) warn(*completed);
  } else {
    for (const std::string& w : roi_->warnings) warn(w);
  }
  return *roi_;
}

const image::Mask& ExportCase::liver() {
  if (liver_) return *liver_;
  const LoadedRoi& r = roi();
  if (r.contours)
    liver_ = roi::rasterise(*r.contours, *mriGrid_);
  else if (mriGrid_ && !r.mask->grid.sameGeometry(*mriGrid_))
    liver_ = image::resampleNearest(*r.mask, *mriGrid_);
  else
    liver_ = *r.mask;
  return *liver_;
}

const roi::ContourStack& ExportCase::contours() {
  if (contours_) return *contours_;
  const LoadedRoi& r = roi();
  const bool excludes = r.contours && std::any_of(r.contours->polygons.begin(), r.contours->polygons.end(),
                                                  [](const roi::Polygon& p) { return p.exclude; });
  // Regions to leave out have no word in other formats: then the outline of what is left is written.
  contours_ = r.contours && !excludes ? *r.contours : roi::contoursOf(liver());
  return *contours_;
}

const image::Mask& ExportCase::liverOnMre() {
  if (liverOnMre_) return *liverOnMre_;
  const LoadedRoi& r = roi();
  elastography::MappedRoi mapped = mapRoi(r, mriGrid_, stiffness());
  for (const std::string& w : mapped.warnings) warn(w);
  liverOnMre_ = std::move(mapped.mask);
  return *liverOnMre_;
}

const RunResult& ExportCase::result() {
  if (result_) return *result_;
  std::shared_ptr<const RunResult> made = request_.solved;
  if (!made) {
    Scene scene = scene_;
    scene.outputs = {};
    scene.outputs.displacementField = true;
    scene.outputs.vessels = scene_.outputs.vessels;
    made = std::make_shared<const RunResult>(run(scene, {}, progress_));
  }
  for (const std::string& w : made->warnings) warn(w);
  warn(made->diagnostics);
  const auto& solver = made->primary.solver;
  if (!solver.converged())
    throw SolverFailed("the scene's solve did not converge: nothing of it is exported", solver.iterations,
                       solver.residual, solver.tolerance);
  result_ = std::move(made);
  return *result_;
}

std::filesystem::path ExportCase::file(const std::string& name) {
  const std::filesystem::path path = request_.output / name;
  if (std::find(exported_.files.begin(), exported_.files.end(), path) == exported_.files.end())
    exported_.files.push_back(path);
  return path;
}

void ExportCase::note(const std::vector<std::filesystem::path>& files) {
  for (const auto& f : files)
    if (std::find(exported_.files.begin(), exported_.files.end(), f) == exported_.files.end())
      exported_.files.push_back(f);
}

void ExportCase::forgetFilesFrom(std::size_t first) {
  std::error_code ignored;
  for (std::size_t n = first; n < exported_.files.size(); ++n) std::filesystem::remove(exported_.files[n], ignored);
  exported_.files.resize(std::min(first, exported_.files.size()));
}

void ExportCase::warn(const Diagnostics& said) {
  for (const Diagnostic& d : said)
    if (!exported_.diagnostics.contains(d.code)) exported_.diagnostics.add(d.code, d.arguments);
  for (const std::string& text : said.texts(Severity::Warning)) warn(text);
}

void ExportCase::warn(const std::string& text) {
  if (std::find(exported_.warnings.begin(), exported_.warnings.end(), text) == exported_.warnings.end())
    exported_.warnings.push_back(text);
}

}  // namespace glisson::pipeline::detail
