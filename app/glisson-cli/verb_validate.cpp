#include "study/beam_report.h"
#include "study/contact_study.h"
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
  verb->callback(
      [&context, problem, options] {
        context.action = [&context, problem, options] {
          return *problem == "contact" ? validateContact(options->quick, context) : validate(*options, context);
        };
      });
}

}  // namespace glisson::cli
