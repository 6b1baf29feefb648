// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "base/quantity_names.h"
#include "diagnostics_json.h"
#include "elastography/reading.h"
#include "pipeline/measure.h"
#include "roles_option.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct MeasureArguments {
  pipeline::MeasureRequest request;
  std::string quantity, unit;
  std::vector<std::string> roles;
};

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

/// What a reader has to know beside the mean.
Json toJson(const elastography::Reading& r, const elastography::Measurement& m) {
  Json slices = Json::array();
  for (const elastography::Reading::Slice& s : r.slices)
    slices.push_back({{"slice", s.slice}, {"fault", nameOf(s.fault)}});
  return {{"outlined_voxels", m.drawn},
          {"share_measured", r.shareMeasured},
          {"mean_of_all_kPa", orNull(m.meanOfAll_kPa)},
          {"mean_change", r.meanChange},
          {"change_to_be_real_kPa", orNull(r.changeToBeReal_kPa)},
          {"repeatability_coefficient", elastography::repeatabilityCoefficient},
          {"repeatability_source", "qiba2022mre"},
          {"smallest_region_mm2", elastography::smallestRegion_mm2},
          {"region_small", r.small},
          {"slices_failed", r.failed},
          {"slices", slices}};
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

/// How the elastogram was acquired, as far as its files say.
Json acquisitionOf(const pipeline::LoadedStiffness& mre) {
  if (mre.acquisition.stiffness < 0) return nullptr;
  const dicom::Series& series = mre.scan->series[static_cast<std::size_t>(mre.acquisition.stiffness)];
  const auto orUnknown = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  return {{"manufacturer", orUnknown(series.acquired.manufacturer)},
          {"sequence", orUnknown(series.acquired.sequenceName)},
          {"vibration_Hz", series.vibration_Hz ? Json(*series.vibration_Hz) : Json(nullptr)}};
}

/// For people: a line for each slice, the pooled one, and what stands beside the mean.
std::string inWords(const elastography::Measurement& m, const std::vector<std::string>& warnings) {
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
  const elastography::Reading reading = elastography::readingOf(m);
  text << "a change is real from " << reading.changeToBeReal_kPa << " kPa (19 % of the mean, QIBA profile); "
       << 100 * reading.shareMeasured << " % of what is outlined was measured\n";
  for (const elastography::Reading::Slice& s : reading.slices)
    if (s.fault == elastography::SliceFault::NoReliableWave)
      text << "slice " << s.slice << " is a technical failure: no reliable wave in it\n";
  if (reading.small) text << "the region is smaller than " << elastography::smallestRegion_mm2 << " mm2\n";
  text << "mean Young's modulus " << m.youngs_mean_kPa << " kPa at Poisson's ratio " << m.poisson << "\n";
  for (const std::string& w : warnings) text << "warning: " << w << "\n";
  return text.str();
}

int measure(const MeasureArguments& a, const Context& context) {
  pipeline::MeasureRequest request = a.request;
  if (!a.quantity.empty()) request.quantity = stiffnessQuantityNames.named(a.quantity);
  if (!a.unit.empty()) request.unit = a.unit;
  request.roles = rolesFrom(a.roles);
  const pipeline::MeasuredRegion measured = pipeline::measureRegion(request, context.progress());
  const elastography::Measurement& m = measured.measurement;
  const std::vector<std::string>& warnings = measured.warnings;

  Json j;
  j["quantity"] = stiffnessQuantityNames.nameOf(m.quantity);
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
  if (measured.registration) j["registration"] = toJson(*measured.registration);
  j["area_weighted_mean_kPa"] = orNull(m.areaWeightedMean_kPa);
  j["youngs_mean_kPa"] = orNull(m.youngs_mean_kPa);
  j["shear_mean_kPa"] = orNull(m.shear_mean_kPa);
  j["poisson"] = m.poisson;
  j["roi_coverage"] = measured.region.coverage;
  j["left_out"] = {{"not_finite", m.notFinite},
                   {"not_positive", m.notPositive},
                   {"low_confidence", m.lowConfidence},
                   {"no_confidence", m.noConfidence}};
  j["left_out"]["rim"] = m.rim;
  j["left_out"]["excluded"] = m.excluded;
  j["reading"] = toJson(elastography::readingOf(m), m);
  if (measured.mre.scan) {
    j["sources"] = sourcesOf(measured.mre);
    j["acquisition"] = acquisitionOf(measured.mre);
  }
  j["warnings"] = warnings;
  j["diagnostics"] = diagnosticsJson(measured.diagnostics, warnings);
  refuseIfStrict(context, measured.diagnostics, warnings);

  context.print(j, inWords(m, warnings));
  return Ok;
}

}  // namespace

void addMeasure(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("measure", "stiffness statistics of a region of interest, per slice and pooled");
  auto a = std::make_shared<MeasureArguments>();
  verb->add_option("--mre", a->request.mre, "elastogram: DICOM folder, DICOMDIR or ZIP archive, or a stiffness map")
      ->type_name(value::folderOrVolume)
      ->required();
  verb->add_option("--roi", a->request.roi,
                   "region of interest: contour JSON, RT Structure Set, Segmentation, mask or closed surface")
      ->type_name(value::fileOrMask)
      ->required();
  verb->add_option("--mri", a->request.mri,
                   "image that the contours were drawn on, where its slices differ from the elastogram's")
      ->type_name(value::folderOrVolume);
  verb->add_option("--quantity", a->quantity, "what a bare map holds")
      ->check(CLI::IsMember(stiffnessQuantityNames.words()));
  verb->add_option("--unit", a->unit, "unit of a bare map: Pa, kPa or <factor>kPa");
  verb->add_option("--role", a->roles, "series=role, set by hand: UID or number, and stiffness, confidence ...");
  verb->add_flag("--override", a->request.overrideChecks,
                 "take MRI, elastogram and region of other days or patients nevertheless");
  verb->add_option(
      "--label", a->request.label,
      "label of a mask, 0 = any; must be given where there are several; or number of a structure or segment");
  verb->add_option("--name", a->request.name, "structure of an RT Structure Set, or its number as #2");
  verb->add_option("--confidence", a->request.confidence, "voxels below are left out, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--confidence-scale", a->request.confidenceScale,
                   "stored value of the confidence map that means full confidence, where the map does not tell")
      ->check(CLI::PositiveNumber);
  verb->add_option("--erode,--erode-px", a->request.erosion_pixels,
                   "inner region of interest: pixels to take off the border")
      ->check(CLI::Range(0, 100));
  verb->add_option("--erode-mm", a->request.erosion_mm, "the same in millimetres from the outline")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--exclude", a->request.exclude, "mask of what is left out: large vessels")->type_name(value::mask);
  verb->add_flag("--register", a->request.registration,
                 "correct another breath-hold: lay the magnitude images over --mri");
  verb->add_option("--magnitude", a->request.magnitude, "magnitude images of the elastogram, where they lie elsewhere")
      ->type_name(value::folderOrVolume);
  verb->add_option("--poisson", a->request.poisson, "for Young's modulus; 0.5 is incompressible, E = 3 mu")
      ->check(CLI::Range(0.0, 0.5));
  addSlicerXml(*verb, {"Measure stiffness", {}});
  verb->callback([&context, a] { context.action = [&context, a] { return measure(*a, context); }; });
}

}  // namespace glisson::cli
