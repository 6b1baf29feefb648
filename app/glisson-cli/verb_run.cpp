// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <iostream>
#include <sstream>

#include "base/error.h"
#include "base/quantity.h"
#include "diagnostics_json.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "render/backend.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

/// " (95 %: 4.1 to 10.2)" beside a figure of the difference, in its unit; nothing where the run does not say.
std::string in95(const pipeline::RunResult& r, uncertainty::Interval uncertainty::Headline::*figure) {
  if (!r.uncertainty || !r.uncertainty->known || !r.uncertainty->spread.headline) return "";
  const uncertainty::Interval& i = (*r.uncertainty->spread.headline).*figure;
  std::ostringstream t;
  t.precision(3);
  t << " (95 %: " << i.low << " to " << i.high << ")";
  return t.str();
}

std::string summary(const pipeline::RunResult& r, Language language) {
  using uncertainty::Headline;
  std::ostringstream t;
  t.precision(4);
  const retraction::Result& p = r.primary;
  t << "model       " << p.dofs << " degrees of freedom, " << r.model.cells << " cells, " << r.model.volume_mL
    << " mL, " << r.model.mass_kg << " kg\n"
    << "solver      " << p.solver.kind << ", " << p.solver.iterations << " iterations, residual " << p.solver.residual
    << (p.solver.converged() ? "" : "  NOT CONVERGED") << "\n"
    << "load        (" << p.load_N.transpose() << ") N, reaction (" << p.reaction_N.transpose() << ") N\n"
    << "strain      max " << p.max_strain << ", 95 % below " << p.p95_strain << "; largest rotation "
    << p.max_rotation_deg << " deg\n";
  if (p.contact)
    t << "bar         " << (p.contact->answered() ? "" : "no answer; its last state: ") << "travels "
      << p.contact->travel_mm << " mm and bears " << p.contact->force_N.dot(p.contact->hoist)
      << " N along its hoist (resultant " << p.contact->force_N.norm() << " N) over " << p.contact->footprint_mm2
      << " mm2 seen along it\n";
  if (p.linearTrusted)
    t << "validity    "
      << (p.kinematics == retraction::Kinematics::Linear ? "linear theory can be trusted here"
                                                         : "converged, and no cell is turned inside out")
      << "\n";
  for (const std::string& v : p.validity) t << "validity    " << v << "\n";
  if (r.discretisation) t << "error       " << r.discretisation->note << "\n";
  if (r.difference)
    t << "difference  mean " << r.difference->mean_mm << " mm" << in95(r, &Headline::mean_mm) << ", 95 % below "
      << r.difference->p95_mm << " mm, max " << r.difference->max_mm << " mm, at the retractor "
      << r.difference->at_retractor_mm << " mm" << in95(r, &Headline::at_retractor_mm)
      << (r.difference->clinically_significant ? " (clinically significant)" : "") << "\n";
  if (r.difference && r.difference->travel_mm)
    t << "            travel of the bar " << *r.difference->travel_mm << " mm" << in95(r, &Headline::travel_mm)
      << " (measured less atlas)\n";
  if (r.difference && !r.difference->vessel_mm.empty()) {
    const bool sure = r.uncertainty && r.uncertainty->known && r.uncertainty->spread.headline->vessels;
    t << "            vessels " << r.difference->vesselMax_mm << " mm at most, "
      << 100 * r.difference->vesselFractionBeyond << " % of the landmarks 5 mm or more apart";
    if (sure) {
      const uncertainty::VesselHeadline& v = *r.uncertainty->spread.headline->vessels;
      t << " (95 %: " << v.max_mm.low << " to " << v.max_mm.high << " mm, " << 100 * v.beyond.low << " to "
        << 100 * v.beyond.high << " %)";
    }
    t << "\n";
  }
  if (r.uncertainty && r.uncertainty->known) {
    t << "how sure    " << uncertainty::inWords(r.uncertainty->spread) << "\n";
    const std::string told = uncertainty::forSurgeon(r.uncertainty->tip, r.uncertainty->spread, language);
    if (!told.empty()) t << (language == Language::English ? "in short    " : "kurz        ") << told << "\n";
  }
  for (const std::string& d : r.diagnostics.texts()) t << "diagnosis   " << d << "\n";
  for (const std::string& w : r.warnings) t << "warning     " << w << "\n";
  for (const auto& f : r.files) t << "written     " << f.string() << "\n";
  return t.str();
}

/// Why a run has no answer: what its first error says.
std::string whyOf(const pipeline::RunResult& r) {
  for (const Diagnostic& d : r.diagnostics)
    if (d.severity() == Severity::Error) return d.text();
  return "the solve did not converge";
}

/// What to change where a solve without a bar in contact did not converge; that of the bar says so itself.
std::string adviceFor(const pipeline::Scene& scene, const pipeline::RunResult& r) {
  if (r.primary.contact) return "";
  if (r.primary.kinematics != retraction::Kinematics::Linear)
    return ": lower the load, spread it or stiffen the supports";
  return scene.setup.solver.kind == mechanics::SolverKind::Auto
             ? ": use smaller cells, less contrast between the moduli or a smaller Poisson's ratio"
             : ": raise \"iterations\" or use solver \"auto\"";
}

void useBackend(const Context& context) {
  render::setRenderBackend(context.renderBackend == "egl"   ? render::RenderBackend::Egl
                           : context.renderBackend == "x11" ? render::RenderBackend::X11
                                                            : render::RenderBackend::Auto);
}

/// What a first run shows, for someone who has never seen one; then the same lines as every run.
std::string introduction(const pipeline::RunResult& r, const std::filesystem::path& patient,
                         const std::filesystem::path& output) {
  std::ostringstream t;
  t.precision(3);
  t << "A synthetic patient was written as DICOM, read back, and its liver retracted twice by the same bar: with the\n"
       "stiffness of its elastogram and with the textbook's "
    << defaults::atlasShear.kPa() << " kPa.\n";
  if (r.stiffness) t << "  shear stiffness of this liver   " << r.stiffness->pooled.mean_kPa << " kPa\n";
  if (r.primary.contact && r.atlas && r.atlas->contact)
    t << "  the bar travels                 " << r.primary.contact->travel_mm << " mm; with the textbook's stiffness "
      << r.atlas->contact->travel_mm << " mm\n";
  if (r.difference)
    t << "  the two predictions differ by   " << r.difference->at_retractor_mm << " mm at the bar, "
      << r.difference->mean_mm << " mm on average over the liver\n";
  for (const auto& f : r.files)
    if (f.extension() == ".png") t << "  picture                         " << f.string() << "\n";
  t << "  all of it on one page           " << (output / "report.html").string() << "\n"
    << "Next:  glisson " << patient.string() << "                 (the workstation)\n"
    << "       glisson-cli plan " << (patient / "scene.json").string() << "   (what a run does, and why)\n\n";
  return t.str();
}

/// Runs, prints and judges; an exit code. before: of the result, printed first.
int runScene(const pipeline::Scene& scene, const pipeline::RunOptions& options, const Context& context,
             const Progress& progress, const std::function<std::string(const pipeline::RunResult&)>& before = {}) {
  const pipeline::RunResult r = pipeline::run(scene, options, progress);
  context.print(Json::parse(r.json), (before ? before(r) : std::string()) + summary(r, options.language));
  refuseIfStrict(context, r.diagnostics, r.warnings);
  if (r.primary.solver.converged() && (!r.atlas || r.atlas->solver.converged())) return Ok;
  std::cerr << "glisson-cli: " << whyOf(r) << "; the result is marked and not drawn" << adviceFor(scene, r)
            << std::endl;
  return NotConverged;
}

}  // namespace

void addRun(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("run", "do everything that a scene needs; write results, pictures and run.json");
  auto scenePath = std::make_shared<std::filesystem::path>();
  auto colourBlind = std::make_shared<bool>(false);
  auto overrideChecks = std::make_shared<bool>(false);
  verb->add_option("scene", *scenePath, "scene.json, or case.json as the workstation saves it")
      ->type_name(value::file)
      ->required();
  verb->add_flag("--colour-blind", *colourBlind, "orange and blue instead of red and blue");
  verb->add_flag("--override", *overrideChecks, "take MRI and elastogram of other days or patients nevertheless");
  auto howSure = std::make_shared<bool>(false);
  verb->add_flag("--uncertainty", *howSure,
                 "say how sure the answer is, and what drives it (as \"uncertainty\": true)");
  auto language = std::make_shared<std::string>("en");
  verb->add_option("--language", *language, "of the sentence and the pictures of how sure the answer is: en or de")
      ->check(CLI::IsMember({"en", "de"}));
  addSlicerXml(*verb, {"Retract the liver", {PathKind::Folder}});
  verb->callback([&context, scenePath, colourBlind, overrideChecks, howSure, language] {
    context.action = [&context, scenePath, colourBlind, overrideChecks, howSure, language] {
      pipeline::Scene scene = pipeline::readScene(*scenePath);
      scene.geometry.overrideChecks = scene.geometry.overrideChecks || *overrideChecks;
      if (*howSure && !scene.uncertainty) scene.uncertainty.emplace();
      if (context.seedGiven) scene.setup.seed = scene.setup.model.meshfree.seed = context.seed;
      useBackend(context);
      pipeline::RunOptions options;
      const auto here = std::filesystem::is_directory(*scenePath) ? *scenePath : scenePath->parent_path();
      options.output = context.output.empty() ? here / "glisson-run" : context.output;
      options.palette = *colourBlind ? render::Palette::ColourBlind : render::Palette::RedBlue;
      options.language = languageNamed(*language);
      return runScene(scene, options, context, context.progress());
    };
  });
}

void addDemo(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("demo", "a synthetic patient, from DICOM to pictures (--output: glisson-demo)");
  verb->callback([&context] {
    context.action = [&context] {
      const std::filesystem::path folder = context.output.empty() ? "glisson-demo" : context.output;
      const Progress progress = context.progress();
      phantom::PhantomOptions patient;
      patient.seed = context.seed;
      const auto written = phantom::writeCohort(patient, folder, progress.part(0.0, 0.3));
      useBackend(context);
      pipeline::RunOptions options;
      options.output = folder / "run";
      context.note("the patient is in " + written.front().string() + ", what is computed will be in " +
                   options.output.string());
      return runScene(pipeline::readScene(written.front() / "scene.json"), options, context, progress.part(0.3, 1.0),
                      [&](const pipeline::RunResult& r) { return introduction(r, written.front(), options.output); });
    };
  });
}

}  // namespace glisson::cli
