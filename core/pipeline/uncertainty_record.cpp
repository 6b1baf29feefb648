// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/uncertainty_record.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "report/text.h"

namespace glisson::pipeline::detail {
namespace {

using Json = nlohmann::ordered_json;
using report::number;
using uncertainty::Interval;

Json toJson(const Interval& i) {
  return Json::array({i.low, i.high});
}

Json toJson(const uncertainty::VesselTip& tip) {
  Json j = {{"landmark", tip.landmark}, {"moves_mm", tip.moves_mm}, {"within95_mm", tip.place95_mm}};
  if (tip.apart_mm)
    j["difference"] = {
        {"mm", *tip.apart_mm}, {"interval95_mm", toJson(*tip.apart95_mm)}, {"probability_beyond_5mm", *tip.beyond}};
  return j;
}

}  // namespace

std::string in95(const Interval& i, const char* unit) {
  return " (95 %: " + number(i.low, 3) + " to " + number(i.high, 3) + " " + unit + ")";
}

Json uncertaintyToJson(const uncertainty::Uncertainty& u) {
  Json j = {{"known", u.known}};
  if (!u.known) {
    j["why"] = u.why;
    return j;
  }
  j["sentence"] = uncertainty::inWords(u.spread);
  for (const Language language : {Language::English, Language::German})
    if (const std::string text = uncertainty::forSurgeon(u.tip, u.spread, language); !text.empty())
      j["for_surgeons"][nameOf(language)] = text;
  if (u.tip) j["vessel_tip"] = toJson(*u.tip);
  j["atlas"] = "exact by definition";
  j["sources"] = Json::array();
  for (std::size_t i = 0; i < u.spread.sources.size(); ++i) {
    const uncertainty::SourceSpread& s = u.spread.sources[i];
    j["sources"].push_back({{"name", u.words[i].name},
                            {"sd_mm", s.sd_mm},
                            {"mean_sd_mm", s.mean_sd_mm},
                            {"travel_sd_mm", s.travel_sd_mm},
                            {"vessels_sd_mm", s.vessels_sd_mm},
                            {"furthest_vessel_sd_mm", s.furthest_sd_mm},
                            {"spread", u.words[i].spread},
                            {"reference", u.words[i].reference}});
  }
  j["sd_of"] = u.spread.headline ? "difference at the retractor" : "places of the vessels";
  j["checks"] = Json::array();
  for (const uncertainty::Check& c : u.checks)
    j["checks"].push_back(c.found ? Json{{"found", true},
                                         {"change_mm", c.change_mm},
                                         {"missed_mm", c.missed_mm},
                                         {"at_retractor_mm", c.at_retractor_mm},
                                         {"first_order_mm", c.first_order_mm}}
                                  : Json{{"found", false}});
  j["missed_share"] = u.missedShare ? Json(*u.missedShare) : Json(nullptr);
  if (u.leverage)
    j["stiffness_leverage"] = {{"figure", u.spread.headline ? "difference at the retractor" : "travel of the bar"},
                               {"per_10_percent_mm", u.leverage->per10percent_mm},
                               {"half_mL", u.leverage->half_mL},
                               {"half_within_mm", u.leverage->halfWithin_mm}};
  j["fields"] = u.fields;
  j["solves"] = u.solves;
  j["iterations"] = u.iterations;
  return j;
}

void addIntervals(const uncertainty::Uncertainty& u, Json& difference) {
  if (!u.known || !u.spread.headline) return;
  const uncertainty::Headline& h = *u.spread.headline;
  Json& i = difference["interval95"];
  i["mean_mm"] = toJson(h.mean_mm);
  i["at_retractor_mm"] = toJson(h.at_retractor_mm);
  if (h.vessels) {
    i["vessels_mean_mm"] = toJson(h.vessels->mean_mm);
    i["vessels_max_mm"] = toJson(h.vessels->max_mm);
    i["vessels_fraction_beyond_5mm"] = toJson(h.vessels->beyond);
  }
  i["travel_mm"] = toJson(h.travel_mm);
  difference["probability_beyond_5mm"] = h.beyond;
  difference["probability_travel_beyond_5mm"] = h.travelBeyond;
  difference["probability_mean_within_voxel"] = h.withinVoxel;
}

std::vector<double> spreadOf(const uncertainty::Uncertainty& u, std::size_t landmark) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto& all = u.spread.landmarks;
  const auto found =
      std::lower_bound(all.begin(), all.end(), landmark,
                       [](const uncertainty::LandmarkSpread& l, std::size_t i) { return l.landmark < i; });
  if (found == all.end() || found->landmark != landmark) return std::vector<double>(spreadColumns.size(), none);
  const Interval interval = found->difference95_mm.value_or(Interval{none, none});
  return {found->sd_mm,  found->textbook_sd_mm.value_or(none), found->difference_sd_mm.value_or(none), interval.low,
          interval.high, found->beyond.value_or(none)};
}

void howSure(const uncertainty::Uncertainty& u, Language language, report::Page& page) {
  page.heading("How sure?");
  if (!u.known) {
    page.paragraph("How sure this answer is cannot be told: " + u.why + ".");
    return;
  }
  if (const std::string text = uncertainty::forSurgeon(u.tip, u.spread, language); !text.empty())
    page.paragraph(text + ".");
  std::string sentence = uncertainty::inWords(u.spread);
  sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  page.paragraph(sentence + ".");
  if (u.spread.headline) {
    const uncertainty::Headline& h = *u.spread.headline;
    std::vector<std::vector<std::string>> rows = {
        {"5 mm or more apart at the retractor", uncertainty::percent(h.beyond, Language::English)}};
    if (h.vessels)
      rows.push_back({"5 mm or more apart at the vessel furthest apart",
                      uncertainty::percent(h.vessels->furthestBeyond, Language::English)});
    rows.push_back({"5 mm or more in the travel of the bar", uncertainty::percent(h.travelBeyond, Language::English)});
    rows.push_back({"One MRI voxel (" + number(defaults::mriVoxel.mm()) + " mm) or less, mean over the body",
                    uncertainty::percent(h.withinVoxel, Language::English)});
    page.table({"The two predictions are", "with a probability of"}, rows);
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < u.spread.sources.size(); ++i) {
    const uncertainty::SourceSpread& s = u.spread.sources[i];
    rows.push_back({u.words[i].name, u.words[i].spread, number(s.sd_mm, 2) + " mm", number(s.vessels_sd_mm, 2) + " mm",
                    number(s.furthest_sd_mm, 2) + " mm", number(s.travel_sd_mm, 2) + " mm"});
  }
  page.table(
      {"Source (one standard deviation)", "of what", u.spread.headline ? "difference at the retractor" : "vessels",
       "place of the vessels", "difference at the vessel furthest apart", "travel of the bar"},
      rows);
  if (u.leverage)
    page.paragraph("Where the elastogram matters: half of what the liver's stiffness does to the " +
                   std::string(u.spread.headline ? "difference at the retractor" : "travel of the bar") +
                   " comes from " + number(u.leverage->half_mL, 2) + " mL of tissue, and half from within " +
                   number(u.leverage->halfWithin_mm, 2) +
                   " mm of the contact. A liver 10 % stiffer throughout moves it by " +
                   number(u.leverage->per10percent_mm, 2) + " mm.");
  page.paragraph(
      "Intervals hold 95 %. The textbook stiffness is exact by definition: it is what one would have assumed. " +
      std::to_string(u.checks.size()) + " draws of all sources were solved in full; " +
      (u.missedShare ? "the first order was " + number(100 * *u.missedShare, 2) + " % off them."
                     : "none of them has an answer near this one, so what the first order misses is not known."));
}

}  // namespace glisson::pipeline::detail
