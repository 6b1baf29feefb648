// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "base/quantity_names.h"
#include "diagnostics_json.h"
#include "pipeline/readers.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct AgreeArguments {
  pipeline::ReaderRequest request;
  std::string quantity, unit;
};

Json toJson(const roi::Agreement& a) {
  return {{"dice", a.dice},
          {"jaccard", a.jaccard},
          {"hausdorff_mm", a.hausdorff_mm},
          {"hausdorff95_mm", a.hausdorff95_mm},
          {"mean_surface_distance_mm", a.meanSurfaceDistance_mm},
          {"volume_difference_mL", a.volumeDifference_mL},
          {"volume_difference_percent", a.volumeDifference_percent},
          {"slices_only_in_first", a.slicesOnlyInA},
          {"slices_only_in_other", a.slicesOnlyInB}};
}

Json toJson(const elastography::Correlation& c) {
  return {{"value", orNull(c.value)}, {"low", orNull(c.low)}, {"high", orNull(c.high)}};
}

Json withValue(const elastography::Interval& i) {
  return {{"value", orNull(i.value)}, {"se", orNull(i.se)}, {"ci95", {orNull(i.low), orNull(i.high)}}};
}

/// Keys as in the agreement itself.
Json toJson(const pipeline::ReaderIntervals& i) {
  Json j = {{"slices", i.slices},
            {"dice", withValue(i.dice)},
            {"jaccard", withValue(i.jaccard)},
            {"volume_difference_mL", withValue(i.volumeDifference_mL)},
            {"volume_difference_percent", withValue(i.volumeDifference_percent)}};
  if (i.stiffnessDifference_kPa) j["stiffness_difference_kPa"] = withValue(*i.stiffnessDifference_kPa);
  return j;
}

Json overCases(const std::optional<elastography::ReaderReliability>& reliability,
               const std::optional<elastography::BlandAltman>& limits) {
  Json j;
  if (reliability) {
    j["icc_2_1"] = toJson(reliability->icc21);
    j["icc_3_1"] = toJson(reliability->icc31);
    j["icc_1_1"] = toJson(reliability->icc11);
  }
  if (limits)
    j["bland_altman"] = {{"n", limits->n},
                         {"bias", limits->bias},
                         {"bias_ci", {limits->bias_low, limits->bias_high}},
                         {"sd", limits->sd},
                         {"limits", {limits->lowLimit, limits->highLimit}},
                         {"limit_ci_half_width", limits->limit_ci}};
  return j;
}

int agree(AgreeArguments a, const Context& context) {
  if (!a.quantity.empty()) a.request.meaning.quantity = stiffnessQuantityNames.named(a.quantity);
  if (!a.unit.empty()) a.request.meaning.unit = a.unit;
  const pipeline::ReaderStudy study = pipeline::compareReaders(a.request, context.progress());
  Json j;
  std::ostringstream text;
  text.precision(4);
  j["cases"] = Json::array();
  for (const pipeline::ReadersOfCase& c : study.cases) {
    Json one = {{"case", c.name}, {"volume_mL", c.volume_mL}};
    if (!c.stiffness_kPa.empty()) one["mean_stiffness_kPa"] = c.stiffness_kPa;
    for (const elastography::Interval& mean : c.stiffnessMean_kPa)
      one["mean_stiffness_uncertainty"].push_back(withValue(mean));
    for (std::size_t r = 0; r < c.agreement.size(); ++r) {
      const roi::Agreement& g = c.agreement[r];
      one["with_first"].push_back(toJson(g));
      one["with_first"].back()["by_slices"] = toJson(c.intervals[r]);
      text << c.name << "  Dice " << g.dice << ", Jaccard " << g.jaccard << ", Hausdorff " << g.hausdorff_mm
           << " mm (95 %: " << g.hausdorff95_mm << "), mean distance " << g.meanSurfaceDistance_mm << " mm, volume "
           << g.volumeA_mL << " and " << g.volumeB_mL << " mL\n";
    }
    for (const double s : c.stiffness_kPa) text << c.name << "  mean stiffness " << s << " kPa\n";
    j["cases"].push_back(one);
  }
  if (study.volume) j["volume"] = overCases(study.volume, study.volumeLimits);
  if (study.stiffness) j["stiffness"] = overCases(study.stiffness, study.stiffnessLimits);
  for (const char* key : {"volume", "stiffness"})
    if (j.contains(key)) text << key << "  " << j[key].dump() << "\n";
  refuseIfStrict(context, {}, study.warnings);
  j["warnings"] = study.warnings;
  for (const std::string& w : study.warnings) text << "warning: " << w << "\n";
  j["files"] = Json::array();
  if (!context.output.empty())
    for (const auto& file : pipeline::writeReaders(context.output, study)) {
      j["files"].push_back(file.string());
      text << "written " << file.string() << "\n";
    }
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addAgree(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("agree", "how well readers agree: overlap, distances, ICC, limits of agreement");
  auto a = std::make_shared<AgreeArguments>();
  verb->add_option("readers", a->request.readers, "a region each, or a folder each with one file per case")
      ->type_name(value::fileOrFolder)
      ->required()
      ->expected(2, 20);
  verb->add_option("--mri", a->request.mri, "image (or folder of images) that outlines were drawn on")
      ->type_name(value::folderOrVolume);
  verb->add_option("--mre", a->request.mre, "elastogram (or folder of them): mean stiffness of each reader too")
      ->type_name(value::folderOrVolume);
  verb->add_option("--quantity", a->quantity, "what a bare map holds")
      ->check(CLI::IsMember(stiffnessQuantityNames.words()));
  verb->add_option("--unit", a->unit, "unit of a bare map: Pa, kPa or <factor>kPa");
  verb->add_option("--label", a->request.label, "label of masks, 0 = any");
  verb->add_option("--name", a->request.name, "structure of RT Structure Sets");
  verb->add_flag("--override", a->request.overrideChecks, "compare outlines of other days or patients nevertheless");
  verb->add_flag("--outlines", a->request.outlines, "distances in each slice, for few and thick slices");
  verb->callback([&context, a] { context.action = [&context, a] { return agree(*a, context); }; });
}

}  // namespace glisson::cli
