// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/version.h"
#include "study/beam_report.h"
#include "study/contact_study.h"
#include "study/credibility.h"
#include "study_json.h"

namespace glisson::cli {
namespace {

Json reference(double tip_mm, double gap_mm, const std::string& gapOf) {
  return {{"tip_mm", tip_mm}, {"gap_mm", gap_mm}, {"gap_is", gapOf}};
}

int validate(const study::BeamOptions& options, const Context& context) {
  const study::BeamStudy s = study::studyBeam(options, context.progress());
  Json j;
  j["poisson"] = options.poisson;
  j["load_N_per_m"] = s.load_N_m;
  j["allowed_mm"] = s.allowed_mm;
  j["references"][study::converged3d] = {{"tip_mm", s.clamped.axis_mm.back()},
                                         {"uncertainty_mm", s.clamped.uncertainty_mm},
                                         {"order", s.clamped.order},
                                         {"grid", s.clamped.grid},
                                         {"dofs", s.clamped.dofs}};
  j["references"][study::timoshenko] =
      reference(s.timoshenkoTip_mm, s.gapTimoshenkoTip_mm, "3-D with the Poisson-free root - Timoshenko, tip");
  j["references"][study::eulerBernoulli] =
      reference(s.eulerBernoulliTip_mm, s.gapEulerBernoulliTip_mm, "3-D clamped - Euler-Bernoulli, tip");
  j["references"][study::eulerBernoulli]["gap_axis_mm"] = s.gapEulerBernoulliAxis_mm;
  j["goals"] = Json::array();
  for (const study::BeamGoal& g : s.goals)
    j["goals"].push_back({{"what", g.what},
                          {"poisson", g.poisson},
                          {"quantity", g.quantity},
                          {"value", g.value},
                          {"limit", g.limit},
                          {"met", g.met()},
                          {"beside", g.beside}});
  j["rows"] = toJson(s.rows);
  std::string text = s.summary() + study::table(s.rows);
  j["files"] = Json::array();
  if (!context.output.empty()) {
    for (const auto& file : study::writeBeamStudy(context.output, s)) {
      j["files"].push_back(file.string());
      text += "written " + file.string() + "\n";
    }
  }
  context.print(j, text);
  return Ok;
}

int validateContact(bool quick, const Context& context) {
  const study::ContactStudy s = study::studyContact({quick}, context.progress());
  Json j = {{"rows", toJson(s.rows)}, {"files", Json::array()}};
  std::string text = s.summary() + study::table(s.rows);
  if (!context.output.empty())
    for (const auto& file : study::writeContactStudy(context.output, s)) {
      j["files"].push_back(file.string());
      text += "written " + file.string() + "\n";
    }
  context.print(j, text);
  return Ok;
}

Json lineJson(const study::Evidence& e) {
  const auto orNull = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  Json figures = Json::array();
  for (const study::EvidenceFigure& f : e.figures)
    figures.push_back({{"name", f.name}, {"value", f.value}, {"unit", f.unit}});
  return {{"topic", study::nameOf(e.topic)}, {"what", e.what},
          {"state", study::nameOf(e.state)}, {"found", orNull(e.found)},
          {"wanted", orNull(e.wanted)},      {"why", orNull(e.why)},
          {"command", orNull(e.command)},    {"figures", figures}};
}

int credibility(bool quick, const Context& context) {
  const study::Credibility s = study::studyCredibility({quick, context.seed}, context.progress());
  Json j = {{"standard", "ASME V&V 40-2018"}, {"version", version()},  {"commit", buildCommit()}, {"quick", quick},
            {"seed", context.seed},           {"lines", Json::array()}};
  for (const study::Evidence& e : s.lines) j["lines"].push_back(lineJson(e));
  std::string text = study::table(s);
  Json files = Json::array();
  if (!context.output.empty()) {
    for (const auto& file : study::writeCredibility(context.output, s)) files.push_back(file.string());
    writeAtomically(context.output / "credibility.json", j.dump(1) + "\n");
    files.push_back((context.output / "credibility.json").string());
    for (const auto& file : files) text += "written " + file.get<std::string>() + "\n";
  }
  j["files"] = files;
  context.print(j, text);
  return Ok;
}

}  // namespace

void addValidate(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("validate", "known problems: every method and resolution, error against run time");
  auto problem = std::make_shared<std::string>("beam");
  auto options = std::make_shared<study::BeamOptions>();
  verb->add_option("problem", *problem, "beam: cantilever 50 x 10 x 10 mm; contact: a rigid bar and large deformation")
      ->check(CLI::IsMember({"beam", "contact"}));
  verb->add_option("--poisson", options->poisson, "Poisson's ratio")->check(CLI::Range(-0.9, 0.4999));
  verb->add_option("--tip", options->tip_mm, "Euler-Bernoulli tip deflection in mm")->check(CLI::Range(1e-6, 10.0));
  verb->add_flag("--quick", options->quick, "fewer methods and resolutions");
  auto page = std::make_shared<bool>(false);
  verb->add_flag("--credibility", *page,
                 "instead: the page after ASME V&V 40 (HTML, PDF, JSON), every figure computed for it");
  verb->callback([&context, problem, options, page] {
    context.action = [&context, problem, options, page] {
      if (*page) return credibility(options->quick, context);
      return *problem == "contact" ? validateContact(options->quick, context) : validate(*options, context);
    };
  });
}

}  // namespace glisson::cli
