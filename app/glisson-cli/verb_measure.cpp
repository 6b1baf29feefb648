#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "image/io.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "pipeline/breath_hold.h"
#include "pipeline/region_file.h"
#include "pipeline/sources.h"
#include "roles_option.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
  std::filesystem::path mre, roi, mri, exclude, magnitude;
  bool registration = false;
  std::string quantity, unit, name;
  std::vector<std::string> roles;
  bool overrideChecks = false;
  std::optional<int> label;
  int erosion_pixels = 0;
  double erosion_mm = 0.0;
  std::optional<double> confidence, confidenceScale;
  double poisson = 0.5;
};

Json orNull(double v) {
  return std::isfinite(v) ? Json(v) : Json(nullptr);
}

Json toJson(const elastography::Statistics& s) {
  Json j;
  j["n"] = s.n;
  j["n_before_mask"] = s.n_before_mask;
  j["area_mm2"] = s.area_mm2;
  j["mean_kPa"] = orNull(s.mean_kPa);
  j["median_kPa"] = orNull(s.median_kPa);
  j["sd_kPa"] = orNull(s.sd_kPa);
  j["min_kPa"] = orNull(s.min_kPa);
  j["max_kPa"] = orNull(s.max_kPa);
  return j;
}

Json toJson(const elastography::Interval& i) {
  return {{"se_kPa", orNull(i.se)}, {"ci95_kPa", {orNull(i.low), orNull(i.high)}}};
}

/// The larger one of both, and each way.
Json toJson(const elastography::MeanInterval& u) {
  Json j = toJson(u.mean);
  j["by_correlation"] = {{"length_mm", u.correlation.length_mm},
                         {"exponent", u.correlation.exponent},
                         {"effective_voxels", u.correlation.effective},
                         {"se_kPa", orNull(u.correlation.se_kPa)}};
  j["by_slices"] = toJson(u.bySlices);
  j["by_slices"]["slices"] = u.slices;
  return j;
}

Json toJson(const elastography::Registration& r) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i)
    rows.push_back({r.X_fixed_moving(i, 0), r.X_fixed_moving(i, 1), r.X_fixed_moving(i, 2), r.X_fixed_moving(i, 3)});
  return {{"mri_from_mre", rows},
          {"shift_mm", r.shift_mm},
          {"rotation_deg", r.rotation_deg},
          {"similarity_before", r.similarityBefore},
          {"similarity_after", r.similarityAfter}};
}

/// The series that were used, by uid.
Json sourcesOf(const pipeline::LoadedStiffness& mre) {
  const auto uid = [&mre](int i) {
    return i < 0 ? Json(nullptr) : Json(mre.scan->series[static_cast<std::size_t>(i)].uid);
  };
  return {{"stiffness", uid(mre.acquisition.stiffness)},
          {"confidence", uid(mre.acquisition.confidence)},
          {"magnitude", uid(mre.acquisition.magnitude)}};
}

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The warnings but for the texts of notes.
std::vector<std::string> withoutNotes(std::vector<std::string> warnings, const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics)
    if (d.severity() == Severity::Note) std::erase(warnings, d.text());
  return warnings;
}

/// Where nothing can be measured, what is odd about the region's place is the likely reason.
elastography::Measurement measured(const elastography::StiffnessMap& map, const elastography::MappedRoi& mapped,
                                   const elastography::MeasureOptions& options) {
  try {
    return elastography::measure(map, mapped.mask, options);
  } catch (const BadInput& e) {
    if (mapped.warnings.empty()) throw;
    throw BadInput(std::string(e.what()) + "; " + mapped.warnings.front());
  }
}

int measure(const Arguments& a, const Context& context) {
  pipeline::MapMeaning meaning;
  if (!a.quantity.empty())
    meaning.quantity = a.quantity == "shear" ? StiffnessQuantity::Shear : StiffnessQuantity::Youngs;
  if (!a.unit.empty()) meaning.unit = a.unit;
  meaning.roles = rolesFrom(a.roles);
  meaning.mayBeUneven = true;
  const Progress progress = context.progress();
  meaning.confidenceScale = a.confidenceScale;
  if (!a.label)
    if (const std::string labels = pipeline::severalLabels(a.roi); !labels.empty())
      throw BadInput("'" + a.roi.filename().string() + "' holds the labels " + labels +
                     ": choose the region's with --label (0 takes all of them together)");
  // The region first: it says which images it was drawn on.
  const pipeline::LoadedRoi roi = pipeline::loadRoi(a.roi, a.name, a.label.value_or(0), progress.part(0.0, 0.2));
  meaning.outlined = roi.names;
  pipeline::LoadedStiffness mre = pipeline::loadStiffness(a.mre, meaning, progress.part(0.2, 0.8));
  if (a.registration && a.mri.empty()) throw BadInput("a breath-hold correction needs the image to fit to: give --mri");
  std::optional<image::Grid> mriGrid;
  std::optional<elastography::Registration> registration;
  std::vector<std::string> together;
  std::vector<std::vector<std::string>> rolesNotFound = {mre.rolesNotFound};
  std::optional<pipeline::AnatomicalImage> mri;
  if (!a.mri.empty()) {
    mri = pipeline::loadImage(a.mri, progress.part(0.8, 0.9), meaning.roles, roi.names);
    mriGrid = mri->volume.grid;
    together = pipeline::checkTogether(*mri, mre, a.overrideChecks);
    rolesNotFound.push_back(mri->rolesNotFound);
  }
  const auto said = pipeline::checkRoi(roi, mri ? &*mri : nullptr, &mre, a.overrideChecks);
  together.insert(together.end(), said.begin(), said.end());
  if (a.registration && !mre.map.unevenSlices_mm.empty())
    throw BadInput("a breath-hold correction needs evenly spaced slices, and the elastogram's are not");
  if (!a.exclude.empty() && !mre.map.unevenSlices_mm.empty())
    throw BadInput("a mask of what is left out needs evenly spaced slices, and the elastogram's are not; take it off the "
                   "region of interest instead");
  Diagnostics diagnostics = mre.diagnostics;
  diagnostics.add(roi.diagnostics);
  if (mri) diagnostics.add(mri->diagnostics);
  if (mri) append(together, withoutNotes(mri->warnings, mri->diagnostics));
  const Diagnostics doubts = pipeline::doubtsAboutOutline(roi, mri ? &*mri : nullptr, &mre);
  diagnostics.add(doubts);
  append(together, doubts.texts());
  if (a.registration) registration = pipeline::fitToMri(mre, a.mre, a.magnitude, mri->volume, progress.part(0.9, 1.0));
  pipeline::checkRolesFound(meaning.roles, rolesNotFound);
  const elastography::MappedRoi mapped = pipeline::mapRoi(roi, mriGrid, mre.map);

  elastography::MeasureOptions options;
  options.confidenceThreshold = a.confidence.value_or(defaults::confidenceThreshold);
  if (a.confidence && !mre.map.confidence)
    mre.warnings.push_back("--confidence was not used: the map comes without a confidence map");
  options.erosion_pixels = a.erosion_pixels;
  options.erosion_mm = a.erosion_mm;
  std::optional<image::Mask> excluded;
  if (!a.exclude.empty()) {
    Diagnostics about;
    excluded = image::resampleNearest(image::readMask(a.exclude, 0, &about), mre.map.values_kPa.grid);
    options.exclude = &*excluded;
    if (!image::overlap(*excluded, mapped.mask)) about.add(DiagnosticCode::ExclusionElsewhere);
    diagnostics.add(about);
    for (const std::string& w : about.texts(Severity::Warning))
      if (std::find(mre.warnings.begin(), mre.warnings.end(), w) == mre.warnings.end()) mre.warnings.push_back(w);
  }
  options.poisson = a.poisson;
  const elastography::Measurement m = measured(mre.map, mapped, options);
  progress.report(1.0, "measured");

  Json j;
  j["quantity"] = m.quantity == StiffnessQuantity::Shear ? "shear" : "youngs";
  j["pooled"] = toJson(m.pooled);
  j["slices"] = Json::array();
  for (const elastography::SliceStatistics& s : m.slices) {
    Json one = {{"slice", s.slice}};
    one.update(toJson(s.statistics));
    j["slices"].push_back(one);
  }
  j["mean_se_kPa"] = orNull(m.uncertainty.se_kPa);
  j["mean_ci95_kPa"] = {orNull(m.uncertainty.low_kPa), orNull(m.uncertainty.high_kPa)};
  j["correlated_voxels"] = m.uncertainty.correlatedVoxels;
  j["mean_uncertainty"] = toJson(m.interval);
  if (registration) j["registration"] = toJson(*registration);
  j["area_weighted_mean_kPa"] = orNull(m.areaWeightedMean_kPa);
  j["youngs_mean_kPa"] = orNull(m.youngs_mean_kPa);
  j["shear_mean_kPa"] = orNull(m.shear_mean_kPa);
  j["poisson"] = m.poisson;
  j["roi_coverage"] = mapped.coverage;
  j["left_out"] = {{"not_finite", m.notFinite},
                   {"not_positive", m.notPositive},
                   {"low_confidence", m.lowConfidence},
                   {"no_confidence", m.noConfidence}};
  if (mre.scan) j["sources"] = sourcesOf(mre);
  std::vector<std::string> warnings = mre.warnings;
  for (const std::vector<std::string>* more :
       std::initializer_list<const std::vector<std::string>*>{&together, &roi.warnings, &mapped.warnings, &m.warnings})
    warnings.insert(warnings.end(), more->begin(), more->end());
  j["warnings"] = warnings;
  diagnostics.add(mapped.diagnostics);
  diagnostics.add(m.diagnostics);
  j["diagnostics"] = diagnosticsJson(diagnostics, warnings);
  refuseIfStrict(context, diagnostics, warnings);

  std::ostringstream text;
  text.precision(4);
  auto line = [&](const std::string& name, const elastography::Statistics& s) {
    text << name << "  " << s.n_before_mask << " px -> " << s.n << " after mask, " << s.area_mm2 << " mm2, "
         << s.mean_kPa << " +- " << s.sd_kPa << " kPa, median " << s.median_kPa << ", " << s.min_kPa << " to "
         << s.max_kPa << "\n";
  };
  text << (m.quantity == StiffnessQuantity::Shear ? "shear modulus" : "Young's modulus") << "\n";
  for (const elastography::SliceStatistics& s : m.slices) line("slice " + std::to_string(s.slice), s.statistics);
  line("pooled", m.pooled);
  text << "mean Young's modulus " << m.youngs_mean_kPa << " kPa at Poisson's ratio " << m.poisson << "\n";
  for (const std::string& w : warnings) text << "warning: " << w << "\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addMeasure(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("measure", "stiffness statistics of a region of interest, per slice and pooled");
  auto a = std::make_shared<Arguments>();
  verb->add_option("--mre", a->mre, "elastogram: DICOM folder, DICOMDIR or ZIP archive, or a stiffness map")
      ->type_name(value::folderOrVolume)
      ->required();
  verb->add_option("--roi", a->roi,
                   "region of interest: contour JSON, RT Structure Set, Segmentation, mask or closed surface")
      ->type_name(value::fileOrMask)
      ->required();
  verb->add_option("--mri", a->mri,
                   "image that the contours were drawn on, where its slices differ from the elastogram's")
      ->type_name(value::folderOrVolume);
  verb->add_option("--quantity", a->quantity, "what a bare map holds")->check(CLI::IsMember({"shear", "youngs"}));
  verb->add_option("--unit", a->unit, "unit of a bare map: Pa, kPa or <factor>kPa");
  verb->add_option("--role", a->roles, "series=role, set by hand: UID or number, and stiffness, confidence ...");
  verb->add_flag("--override", a->overrideChecks,
                 "take MRI, elastogram and region of other days or patients nevertheless");
  verb->add_option(
      "--label", a->label,
      "label of a mask, 0 = any; must be given where there are several; or number of a structure or segment");
  verb->add_option("--name", a->name, "structure of an RT Structure Set, or its number as #2");
  verb->add_option("--confidence", a->confidence, "voxels below are left out, 0 to 1")->check(CLI::Range(0.0, 1.0));
  verb->add_option("--confidence-scale", a->confidenceScale,
                   "stored value of the confidence map that means full confidence, where the map does not tell")
      ->check(CLI::PositiveNumber);
  verb->add_option("--erode,--erode-px", a->erosion_pixels, "inner region of interest: pixels to take off the border")
      ->check(CLI::Range(0, 100));
  verb->add_option("--erode-mm", a->erosion_mm, "the same in millimetres from the outline")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--exclude", a->exclude, "mask of what is left out: large vessels")->type_name(value::mask);
  verb->add_flag("--register", a->registration, "correct another breath-hold: lay the magnitude images over --mri");
  verb->add_option("--magnitude", a->magnitude, "magnitude images of the elastogram, where they lie elsewhere")
      ->type_name(value::folderOrVolume);
  verb->add_option("--poisson", a->poisson, "for Young's modulus; 0.5 is incompressible, E = 3 mu")
      ->check(CLI::Range(0.0, 0.5));
  addSlicerXml(*verb, {"Measure stiffness", {}});
  verb->callback([&context, a] { context.action = [&context, a] { return measure(*a, context); }; });
}

}  // namespace glisson::cli
