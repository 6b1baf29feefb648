// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "live/server.h"
#include "pipeline/models.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct LiveArguments {
  std::filesystem::path scene, run;
  live::ServerOptions options;
  bool headless = false;
  std::string frame = "ras", model = "auto";
};

/// Points at rest and how a run moved them, with the measured stiffness; LPS, mm.
struct RunAnswer {
  std::vector<Eigen::Vector3d> p_mm, u_mm;
};

/// From the record of a run: its vessel landmarks, or its probes where it has none.
RunAnswer answerOf(const std::filesystem::path& folder) {
  RunAnswer answer;
  if (std::ifstream csv(folder / "vessels.csv"); csv) {
    std::string line;
    std::getline(csv, line);
    while (std::getline(csv, line)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream row(line);
      double n = 0, radius = 0;
      Eigen::Vector3d p, u;
      if (!(row >> n >> p.x() >> p.y() >> p.z() >> radius >> u.x() >> u.y() >> u.z()))
        throw BadInput("vessels.csv of the run cannot be read; run the scene again");
      answer.p_mm.push_back(p);
      answer.u_mm.push_back(u);
    }
    return answer;
  }
  std::ifstream file(folder / "run.json");
  if (!file) throw BadInput("the folder given by --run holds no run: neither vessels.csv nor run.json");
  const Json record = Json::parse(file, nullptr, false);
  const auto vector = [](const Json& j) { return Eigen::Vector3d(j.at(0), j.at(1), j.at(2)); };
  try {
    for (const Json& probe : record.at("probes")) {
      answer.p_mm.push_back(vector(probe.at("p_mm")));
      answer.u_mm.push_back(vector(probe.at("u_mm")));
    }
  } catch (const Json::exception&) {
    throw BadInput("run.json of the run cannot be read; run the scene again");
  }
  return answer;
}

/// How far the landmarks lie from where the run put them, both at rest under the scene's own drive: what the coarser
/// cells of the live liver cost. Null where the live liver does not come to rest there.
Json againstRun(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& watched, const RunAnswer& run,
                const Progress& progress) {
  constexpr int most = 600;
  constexpr double same_mm = 0.01;
  const auto other = [&] {
    if (run.p_mm.size() != watched.size()) return true;
    for (std::size_t i = 0; i < watched.size(); ++i)
      if ((run.p_mm[i] - watched[i]).norm() > same_mm) return true;
    return false;
  };
  if (other()) throw BadInput("the run given by --run is not of this scene: its landmarks lie elsewhere");
  const retraction::LiveAnswer at = retraction::followScene(livers, most, progress).mre;
  if (!at.atRest || at.outcome != retraction::LiveOutcome::Borne) return nullptr;
  Eigen::Matrix3Xd u_mm;
  livers.mre->displacements(u_mm);
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < watched.size(); ++i) {
    const double off = (u_mm.col(static_cast<Eigen::Index>(i)) - run.u_mm[i]).norm();
    sum += off;
    largest = std::max(largest, off);
  }
  return {{"mean", sum / static_cast<double>(watched.size())}, {"max", largest}};
}

Json toolJson(const retraction::LiveAnswer& at) {
  const auto vector = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  return {{"tool_mm", vector(at.tool_mm)},
          {"force_N", vector(at.force_N)},
          {"at_rest", at.atRest},
          {"slips", at.outcome == retraction::LiveOutcome::Slips},
          {"cuts", at.outcome == retraction::LiveOutcome::Cuts}};
}

/// With which stiffness the last frame ended so; empty where with none.
std::string whoEndedBy(const retraction::LiveAnswers& last, retraction::LiveOutcome outcome) {
  const bool mre = last.mre.outcome == outcome, atlas = last.atlas.outcome == outcome;
  return mre && atlas ? "either stiffness" : mre ? "the measured stiffness" : atlas ? "the atlas stiffness" : "";
}

void warnOfLast(const retraction::LiveAnswers& last, Json& warnings) {
  if (const std::string who = whoEndedBy(last, retraction::LiveOutcome::Slips); !who.empty())
    warnings.push_back("the bar slips with " + who + ": the liver does not bear the force asked for");
  if (const std::string who = whoEndedBy(last, retraction::LiveOutcome::Cuts); !who.empty())
    warnings.push_back(
        "the bar cuts into the liver with " + who +
        ": its cells are drawn apart there, and this state is no answer; use a smaller force or another place");
}

Json recordOf(const live::ServerStatistics& s, const retraction::LiveLivers& livers, std::size_t landmarks,
              bool headless) {
  Json j = {{"model", livers.kind == retraction::LiveKind::Contact ? "contact" : "condensed"},
            {"dofs", livers.mre->dofs()},
            {"cell_mm", livers.mre->cell_mm()},
            {"landmarks", landmarks},
            {"headless", headless},
            {"frames", s.frames},
            {"poses", s.poses},
            {"rate_hz", s.rate_hz},
            {"evaluate_us", s.evaluate_us},
            {"remaining_mm", s.remaining_mm},
            {"remaining_last_mm", std::max(s.last.mre.remaining_mm, s.last.atlas.remaining_mm)},
            {"latency_ms", s.latency_ms},
            {"latency_max_ms", s.latency_max_ms},
            {"slipping_frames", s.slipping},
            {"cutting_frames", s.cutting},
            {"mre", toolJson(s.last.mre)},
            {"atlas", livers.atlas ? toolJson(s.last.atlas) : Json(nullptr)},
            {"warnings", Json::array()}};
  warnOfLast(s.last, j["warnings"]);
  return j;
}

std::string wordsOf(const Json& j) {
  std::ostringstream text;
  text.precision(4);
  text << j["frames"] << " frames at " << j["rate_hz"].get<double>() << " Hz";
  if (!j["headless"].get<bool>()) text << ", " << j["poses"] << " poses";
  text << "; an answer took " << j["evaluate_us"].get<double>() << " us";
  if (!j["headless"].get<bool>())
    text << ", from pose to answer " << j["latency_ms"].get<double>() << " ms (at most "
         << j["latency_max_ms"].get<double>() << " ms)";
  text << '\n';
  if (j["model"] == "contact")
    text << "the solver was at most " << j["remaining_mm"].get<double>()
         << " mm from equilibrium (estimate); the error of its cells of " << j["cell_mm"].get<double>()
         << " mm comes on top" << (j["discretisation_mm"].is_null() ? " (--run DIR tells it)" : "") << '\n';
  if (!j["discretisation_mm"].is_null())
    text << "at rest the landmarks lie " << j["discretisation_mm"]["mean"].get<double>() << " mm (mean), "
         << j["discretisation_mm"]["max"].get<double>() << " mm (at most) from where the run put them\n";
  for (const Json& warning : j["warnings"]) text << "warning: " << warning.get<std::string>() << '\n';
  return text.str();
}

std::string listening(const live::ServerOptions& options, int port, std::size_t landmarks) {
  std::string text = "OpenIGTLink on " + options.bind + ", port " + std::to_string(port) +
                     (options.bind == "127.0.0.1" ? " (this computer alone; --bind opens it to a network), "
                                                  : " (whoever reaches it can connect: there is no password), ") +
                     std::to_string(landmarks) + " landmarks; ";
  text += options.frames > 0 ? "waits for a client and ends after " + std::to_string(options.frames) +
                                   " frames sent (--headless needs no client); Ctrl+C ends before"
                             : std::string("waits for clients; Ctrl+C ends");
  return text;
}

int serveScene(const LiveArguments& a, const Context& context) {
  if (a.headless && a.options.frames < 1)
    throw BadInput("--headless computes frames without a client: give their number with --frames");
  const Progress progress = context.progress();
  const pipeline::Scene scene = pipeline::readScene(a.scene);
  const pipeline::Models models = pipeline::buildModels(scene, true, progress.part(0.0, 0.6));
  const std::vector<Eigen::Vector3d>& watched = pipeline::followedPoints(scene, models);
  const std::optional<RunAnswer> run = a.run.empty() ? std::optional<RunAnswer>() : answerOf(a.run);
  const retraction::LiveKind kind = a.model == "contact"     ? retraction::LiveKind::Contact
                                    : a.model == "condensed" ? retraction::LiveKind::Condensed
                                                             : retraction::liveKindOf(scene.setup);
  const retraction::LiveLivers livers = retraction::makeLive(models.model, models.atlas ? &*models.atlas : nullptr,
                                                             scene.setup, watched, kind, progress.part(0.6, 1.0));
  live::ServerOptions options = a.options;
  options.ras = a.frame == "ras";
  const auto told = [&](int port) { context.note(listening(options, port, watched.size())); };
  Json cells;
  if (run && !a.headless) cells = againstRun(livers, watched, *run, progress);
  const live::ServerStatistics s = a.headless ? live::rehearse(livers, options.frames, progress)
                                              : live::serve(livers, watched, options, told, progress);
  if (run && a.headless) cells = againstRun(livers, watched, *run, progress);
  Json j = recordOf(s, livers, watched.size(), a.headless);
  j["discretisation_mm"] = cells;
  context.print(j, wordsOf(j));
  return Ok;
}

}  // namespace

void addLive(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("live", "stream the retraction over OpenIGTLink; it follows the tool's pose");
  auto a = std::make_shared<LiveArguments>();
  verb->add_option("scene", a->scene, "scene.json or case.json with a retractor")->type_name(value::file)->required();
  verb->add_option("--port", a->options.port, "0 = any free one")->check(CLI::Range(0, 65535));
  verb->add_option("--bind", a->options.bind, "address to listen on; 0.0.0.0 = every network of this computer");
  verb->add_option("--rate", a->options.rate_hz, "frames a second");
  verb->add_option("--landmarks", a->options.landmarks, "landmarks sent at most");
  verb->add_option("--frames", a->options.frames,
                   "end after so many frames sent to clients, which are waited for; 0 = run until Ctrl+C");
  verb->add_flag("--headless", a->headless,
                 "a measurement without a network: --frames frames from rest on, one after another, no client");
  verb->add_option("--run", a->run,
                   "folder of a run of the same scene: tells what the coarser cells of the live liver cost "
                   "(discretisation_mm)")
      ->type_name(value::folder);
  verb->add_option(
          "--model", a->model,
          "contact: a rigid bar in large deformation; condensed: a linear patch, microseconds an answer; auto: as "
          "the scene's retractor")
      ->check(CLI::IsMember({"auto", "contact", "condensed"}));
  verb->add_option("--frame", a->frame, "coordinates of the messages")->check(CLI::IsMember({"ras", "lps"}));
  verb->callback([&context, a] { context.action = [&context, a] { return serveScene(*a, context); }; });
}

}  // namespace glisson::cli
