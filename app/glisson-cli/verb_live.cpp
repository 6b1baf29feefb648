#include <iostream>
#include <sstream>

#include "base/error.h"
#include "live/server.h"
#include "pipeline/models.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
  std::filesystem::path scene;
  live::ServerOptions options;
  std::string frame = "ras", model = "auto";
};

int serveScene(const Arguments& a, const Context& context) {
  const Progress progress = context.progress();
  const pipeline::Scene scene = pipeline::readScene(a.scene);
  const pipeline::Models models = pipeline::buildModels(scene, true, progress.part(0.0, 0.6));
  // Without vessels the probes of the scene are followed.
  const std::vector<Eigen::Vector3d>& watched =
      models.landmarks_mm.empty() ? scene.outputs.probes_mm : models.landmarks_mm;
  if (watched.empty())
    throw BadInput(
        "nothing to follow: the scene has neither vessels (a patient's MRI) nor probes; add {\"probe\": ...}");
  const retraction::LiveKind kind = a.model == "contact"     ? retraction::LiveKind::Contact
                                    : a.model == "condensed" ? retraction::LiveKind::Condensed
                                                             : retraction::liveKindOf(scene.setup);
  const retraction::LiveLivers livers = retraction::makeLive(
      models.model, models.atlas ? &*models.atlas : nullptr, scene.setup, watched, kind, progress.part(0.6, 1.0));
  live::ServerOptions options = a.options;
  options.ras = a.frame == "ras";
  const live::ServerStatistics s = live::serve(
      livers, watched, options,
      [&](int port) {
        context.note("OpenIGTLink on " + options.bind + ", port " + std::to_string(port) +
                     (options.bind == "127.0.0.1" ? " (this computer alone; --bind opens it to a network), "
                                                  : " (whoever reaches it can connect: there is no password), ") +
                     std::to_string(watched.size()) +
                     " landmarks; Ctrl+C ends");
      },
      progress);
  const bool contact = kind == retraction::LiveKind::Contact;
  const Json j = {{"model", contact ? "contact" : "condensed"},
                  {"dofs", livers.mre->dofs()},
                  {"landmarks", watched.size()},
                  {"frames", s.frames},
                  {"poses", s.poses},
                  {"rate_hz", s.rate_hz},
                  {"evaluate_us", s.evaluate_us},
                  {"remaining_mm", s.remaining_mm},
                  {"latency_ms", s.latency_ms},
                  {"latency_max_ms", s.latency_max_ms}};
  std::ostringstream text;
  text.precision(4);
  text << s.frames << " frames at " << s.rate_hz << " Hz, " << s.poses << " poses; an answer took " << s.evaluate_us
       << " us, from pose to answer " << s.latency_ms << " ms (at most " << s.latency_max_ms << " ms)\n";
  if (contact) text << "the livers were at most " << s.remaining_mm << " mm from equilibrium (estimate)\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addLive(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("live", "stream the retraction over OpenIGTLink; it follows the tool's pose");
  auto a = std::make_shared<Arguments>();
  verb->add_option("scene", a->scene, "scene.json or case.json with a retractor")->required();
  verb->add_option("--port", a->options.port, "0 = any free one")->check(CLI::Range(0, 65535));
  verb->add_option("--bind", a->options.bind, "address to listen on; 0.0.0.0 = every network of this computer");
  verb->add_option("--rate", a->options.rate_hz, "frames a second");
  verb->add_option("--landmarks", a->options.landmarks, "landmarks sent at most");
  verb->add_option("--frames", a->options.frames, "end after so many; 0 = run until Ctrl+C");
  verb->add_option("--model", a->model,
                   "contact: a rigid bar in large deformation; condensed: a linear patch, microseconds an answer; auto: as "
                   "the scene's retractor")
      ->check(CLI::IsMember({"auto", "contact", "condensed"}));
  verb->add_option("--frame", a->frame, "coordinates of the messages")->check(CLI::IsMember({"ras", "lps"}));
  verb->callback([&context, a] { context.action = [&context, a] { return serveScene(*a, context); }; });
}

}  // namespace glisson::cli
