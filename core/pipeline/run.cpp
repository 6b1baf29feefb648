#include "pipeline/run.h"

#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <sstream>

#include "anatomy/surface.h"
#include "anatomy/vessels.h"
#include "base/error.h"
#include "base/folder_claim.h"
#include "elastography/statistics.h"
#include "exchange/sofa.h"
#include "image/io.h"
#include "pipeline/detail/build_model.h"
#include "pipeline/detail/needs.h"
#include "pipeline/detail/outputs.h"
#include "pipeline/detail/record.h"
#include "pipeline/detail/told.h"
#include "pipeline/detail/uncertainty_step.h"
#include "retraction/offered.h"

namespace glisson::pipeline {
namespace {

double peak_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Runs steps of the plan by name and notes what each took.
class Steps {
 public:
  Steps(std::vector<PlanStep>& plan, const Progress& progress) : plan_(plan), progress_(progress) {
    for (PlanStep& s : plan_) {
      expected_ += s.needed ? s.seconds + 0.01 : 0.0;
      s.peak_MB = 0.0;
    }
  }
  void run(const std::string& name, const std::function<void(const Progress&)>& work) {
    for (PlanStep& s : plan_) {
      if (s.step != name) continue;
      if (!s.needed) return;
      const double share = (s.seconds + 0.01) / expected_;
      const Progress part = progress_.part(done_, std::min(1.0, done_ + share));
      part.report(0.0, name);
      const auto start = std::chrono::steady_clock::now();
      work(part);
      s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      s.peak_MB = peak_MB();
      done_ = std::min(1.0, done_ + share);
      return;
    }
    throw BadArgument("the plan has no step \"" + name + "\"");
  }
  /// What was done before the steps began: reading. Without it the time is 0: the inputs were there already.
  void noteReading(const std::vector<std::pair<std::string, double>>& seconds) {
    for (PlanStep& s : plan_)
      if (s.step.rfind("read-", 0) == 0) s.seconds = 0.0;
    for (const auto& [step, time] : seconds)
      for (PlanStep& s : plan_)
        if (s.step == step) {
          s.seconds = time;
          s.peak_MB = peak_MB();
        }
  }
  void explain(const std::string& name, const std::string& why) {
    for (PlanStep& s : plan_)
      if (s.step == name) s.why = why;
  }
  void leaveOut(const std::string& name, const std::string& why) {
    for (PlanStep& s : plan_)
      if (s.step == name) {
        s.needed = false;
        s.why = why;
        s.seconds = 0.0;
      }
  }

 private:
  std::vector<PlanStep>& plan_;
  const Progress& progress_;
  double expected_ = 0.0;
  double done_ = 0.0;
};

/// The retraction of a body whose every modulus is 1/factor of the other's, nothing but clamps holding it: u ∝ 1/E.
/// Only for loads that do not depend on the stiffness and supports that are fixed at zero.
bool followsByScaling(const Scene& scene, const retraction::Model& model, const retraction::Model& atlas,
                      double& factor) {
  if (scene.setup.analysis.dynamic || detail::Needs(scene).newton || detail::Needs(scene).rigidBar) return false;
  for (const retraction::SupportSpec& s : scene.setup.supports)
    if (s.kind == retraction::SupportSpec::Kind::Spring || s.displacement_mm != Eigen::Vector3d::Zero()) return false;
  factor = 0.0;
  for (std::size_t i = 0; i < model.youngs_kPa.values.size(); ++i) {
    if (model.youngs_kPa.values[i] == 0.0f) continue;
    const double f = static_cast<double>(model.youngs_kPa.values[i]) / static_cast<double>(atlas.youngs_kPa.values[i]);
    if (factor == 0.0) factor = f;
    if (f != factor) return false;
  }
  return true;
}

std::string framesInWords(const mechanics::MeshfreeOptions& asked, const retraction::Result& r) {
  std::string text = std::to_string(r.frames) + " frames, " + std::to_string(r.dofs) + " degrees of freedom";
  if (r.frames < asked.frames) text += " (" + std::to_string(asked.frames) + " frames were asked for)";
  for (const std::string& note : r.notes) text += "; " + note;
  return text;
}

/// Memory that is free on this machine, MB; nothing where it cannot be told.
std::optional<double> freeMemory_MB() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("MemAvailable:", 0) == 0) return std::stod(line.substr(13)) / 1024.0;
  return {};
}

/// Refuses a scene whose largest step would not fit into the memory, before it is begun.
void requireMemory(const std::vector<PlanStep>& plan) {
  const std::optional<double> free_MB = freeMemory_MB();
  if (!free_MB) return;
  for (const PlanStep& s : plan)
    if (s.needed && s.peak_MB > 0.9 * *free_MB) {
      std::ostringstream text;
      text.precision(3);
      text << "this scene needs about " << s.peak_MB / 1024.0 << " GB for \"" << s.step << "\", and "
           << *free_MB / 1024.0 << " GB are free: use larger cells (cell_mm; twice the edge takes an eighth)";
      throw BadInput(text.str());
    }
}

/// What linear theory misses of a linear answer with a rigid bar, from that in large deformation: one correction from
/// the linear answer would keep its contact.
retraction::LinearGap gapUnderBar(const retraction::Model& model, retraction::Setup setup,
                                  const std::vector<Eigen::Vector3d>& landmarks_mm, const retraction::Result& linear,
                                  const Progress& progress) {
  retraction::LinearGap gap;
  if (!linear.solver.converged()) {
    gap.why = "the linear answer did not converge";
    return gap;
  }
  setup.kinematics = retraction::Kinematics::Hyperelastic;
  const retraction::Result large = retraction::simulate(model, setup, {}, progress);
  if (detail::isAnswer(large)) return retraction::gapBetween(model, linear, large, landmarks_mm);
  gap.why = large.contact->slipped() ? "in large deformation the bar slips" : "in large deformation there is no answer";
  return gap;
}

/// Puts into an answer what linear theory misses of it, where it is not there yet.
void gapOf(const retraction::Model& model, const retraction::Setup& setup,
           const std::vector<Eigen::Vector3d>& landmarks_mm, retraction::Result& result, const Progress& progress) {
  if (result.linearGap) return;
  if (result.kinematics != retraction::Kinematics::Linear) {
    // Chosen by the gap of the first stiffness: that of the second is judged in the same way.
    retraction::Setup inLinearTheory = setup;
    inLinearTheory.kinematics = retraction::Kinematics::Linear;
    retraction::Result linear = retraction::simulate(model, inLinearTheory, {}, progress);
    retraction::judgeByGap(model, inLinearTheory, landmarks_mm, linear);
    result.linearGap = linear.linearGap;
  } else if (result.contact) {
    retraction::putGap(setup, gapUnderBar(model, setup, landmarks_mm, result, progress), result);
  } else {
    retraction::judgeByGap(model, setup, landmarks_mm, result, progress);
  }
}

}  // namespace

RunResult run(const Scene& scene, const RunOptions& options, const Progress& progress, const Inputs* given) {
  if (scene.setup.loads.empty() && scene.setup.supports.empty())
    throw BadInput("the scene has neither supports nor loads; give at least one support and one load");
  const detail::Needs needs(scene);
  RunResult r;
  r.diagnostics.add(toldOf(scene));
  r.plan = plan(scene);
  requireMemory(r.plan);
  Steps steps(r.plan, progress);

  Inputs loaded;
  if (!given && scene.geometry.kind != GeometrySpec::Kind::Box)
    loaded = loadInputs(scene, progress.part(0.0, 0.05));
  else if (!given && needs.map)
    loaded = loadInputs(scene, progress.part(0.0, 0.05));
  const Inputs& inputs = given ? *given : loaded;
  r.warnings = inputs.warnings;
  steps.noteReading(given ? std::vector<std::pair<std::string, double>>{} : inputs.seconds);

  steps.run("measure-stiffness", [&](const Progress&) {
    if (!inputs.stiffness || !inputs.roiOnMre)
      throw BadArgument("run: no elastogram or no region of interest was loaded");
    elastography::MeasureOptions measureOptions;
    measureOptions.poisson = scene.setup.poisson;
    r.stiffness = elastography::measure(*inputs.stiffness, inputs.roiOnMre->mask, measureOptions);
    for (const std::string& w : r.stiffness->warnings) r.warnings.push_back(w);
    for (const Diagnostic& d : r.stiffness->diagnostics)
      if (d.severity() == Severity::Note) r.diagnostics.add(d.code, d.arguments);
  });

  image::Mask cells;
  retraction::Model atlasModel;
  steps.run("mesh", [&](const Progress&) {
    cells = detail::dropLooseIslands(scene, detail::bodyCells(scene, inputs), r.warnings);
    r.model = detail::buildModel(scene, inputs, cells);
    r.model.smooth = detail::smoothBody(scene, inputs);
    if (scene.compare) {
      atlasModel = detail::buildAtlasModel(scene, cells);
      atlasModel.smooth = r.model.smooth;
    }
  });

  retraction::Setup setup = scene.setup;
  steps.run("place-bar", [&](const Progress& p) {
    r.placed = retraction::placeBar(r.model, scene.compare ? &atlasModel : nullptr, setup, p);
    for (retraction::LoadSpec& load : setup.loads)
      if (auto* bar = std::get_if<retraction::Retractor>(&load)) *bar = r.placed->bar;
    if (!r.placed->bears) detail::tellOfPlaces(r);
  });
  anatomy::VesselModel vessels;
  steps.run("vessels", [&](const Progress& p) { vessels = anatomy::findVessels(*inputs.mri, *inputs.liver, p); });
  r.landmarks_mm = vessels.centreline_lps_mm;
  steps.run(needs.timeSteps ? "time-steps" : "solve", [&](const Progress& p) {
    r.primary = retraction::simulate(r.model, setup, scene.outputs.probes_mm, p);
  });
  if (setup.kinematics == retraction::Kinematics::Auto && !needs.timeSteps && !r.primary.contact) {
    retraction::judgeByGap(r.model, setup, r.landmarks_mm, r.primary);
    setup.kinematics = retraction::kinematicsValid(r.primary) && r.primary.linearTrusted
                           ? retraction::Kinematics::Linear
                           : retraction::Kinematics::Hyperelastic;
    if (setup.kinematics != retraction::Kinematics::Linear && !retraction::largeDeformationRefusal(setup)) {
      const std::optional<retraction::LinearGap> missed = r.primary.linearGap;
      r.primary = retraction::simulate(r.model, setup, scene.outputs.probes_mm, progress);
      r.primary.linearGap = missed;
    } else {
      setup.kinematics = retraction::Kinematics::Linear;
    }
  }
  r.kinematicsWhy = detail::whyKinematics(scene, r.primary);
  r.warnings.insert(r.warnings.end(), r.primary.notes.begin(), r.primary.notes.end());
  r.diagnostics.add(r.primary.diagnostics);
  if (scene.setup.model.kind == retraction::ModelKind::Meshfree)
    steps.explain("mesh-free-frames", framesInWords(scene.setup.model.meshfree, r.primary));
  if (scene.compare) {
    double factor = 1.0;
    if (detail::sameStiffness(r.model, atlasModel)) {
      r.atlas = r.primary;
      steps.leaveOut("atlas-solve", "the material is the atlas itself: the second answer is the first");
    } else if (followsByScaling(scene, r.model, atlasModel, factor)) {
      r.atlas = retraction::scaled(atlasModel, setup, scene.outputs.probes_mm, r.primary, factor);
      steps.leaveOut("atlas-solve", "one modulus throughout and clamps only: displacement is proportional to 1/E");
    }
    steps.run("atlas-solve", [&](const Progress& p) {
      r.atlas = retraction::simulate(atlasModel, setup, scene.outputs.probes_mm, p);
    });
  }

  detail::tellOfAtlas(r);

  if (!options.discretisation)
    for (const char* step : {"discretisation-error", "linear-gap"})
      steps.leaveOut(step, "a study that measures errors itself does without the estimate");
  if (r.primary.solver.converged())
    steps.run("discretisation-error", [&](const Progress& p) {
      std::optional<retraction::SecondAnswer> second;
      if (r.atlas && r.atlas->solver.converged()) second.emplace(atlasModel, *r.atlas);
      r.discretisation =
          retraction::discretisationError(r.model, setup, r.primary, p, second ? &*second : nullptr, r.landmarks_mm);
    });

  if (needs.pictures && r.primary.drawable && r.atlas && !r.atlas->drawable)
    r.warnings.push_back("no picture is drawn, because of the atlas prediction: " +
                         (r.atlas->validity.empty() ? "it is no deformation" : r.atlas->validity.front()) +
                         (r.primary.contact
                              ? "; choose another place, a smaller force or larger cells"
                              : "; spread the load (\"spread_mm\" of the retractor), or choose another model "
                                "or larger cells"));

  if (!options.discretisation && !needs.report)
    steps.leaveOut("linear-solve", "a study that measures errors itself does without the estimate");
  steps.run("linear-solve", [&](const Progress& p) {
    if (!r.primary.solver.converged() && !needs.report) return;
    retraction::Setup inLinearTheory = setup;
    inLinearTheory.kinematics = retraction::Kinematics::Linear;
    LinearBeside linear;
    try {
      linear.primary =
          retraction::simulate(r.model, inLinearTheory, scene.outputs.probes_mm, p.part(0.0, r.atlas ? 0.5 : 1.0));
      if (r.atlas)
        linear.atlas =
            detail::sameStiffness(r.model, atlasModel)
                ? linear.primary
                : retraction::simulate(atlasModel, inLinearTheory, scene.outputs.probes_mm, p.part(0.5, 1.0));
    } catch (const BadInput& why) {
      steps.explain("linear-solve", std::string("linear theory does not offer this scene: ") + why.what());
      return;
    }
    const auto gap = [&](const retraction::Model& model, const retraction::Result& answer, retraction::Result& told) {
      if (answer.solver.converged() && told.solver.converged())
        told.linearGap = retraction::gapBetween(model, answer, told, r.landmarks_mm);
      else if (told.solver.converged())
        told.linearGap.emplace().why = "linear theory has no answer here";
    };
    gap(r.model, linear.primary, r.primary);
    if (r.atlas) gap(atlasModel, *linear.atlas, *r.atlas);
    if (!needs.report || !linear.primary.solver.converged() || (linear.atlas && !linear.atlas->solver.converged()))
      return;
    linear.between = comparison::compare(r.model, r.primary, linear.primary, {});
    if (linear.atlas) linear.difference = comparison::compare(r.model, linear.primary, *linear.atlas, {});
    r.linear = std::move(linear);
  });

  detail::tellOfContact(scene, r);
  steps.run("linear-gap", [&](const Progress& p) {
    const double half = r.atlas ? 0.5 : 1.0;
    gapOf(r.model, setup, r.landmarks_mm, r.primary, p.part(0.0, half));
    if (r.atlas && detail::sameStiffness(r.model, atlasModel))
      r.atlas = r.primary;
    else if (r.atlas)
      gapOf(atlasModel, setup, r.landmarks_mm, *r.atlas, p.part(half, 1.0));
  });
  const bool comparable = r.atlas && detail::isAnswer(r.primary) && detail::isAnswer(*r.atlas);
  if (r.atlas && !comparable) {
    detail::withhold(r);
    steps.leaveOut("difference", "one of the two runs is no answer");
  }
  steps.run("difference", [&](const Progress&) {
    r.difference = comparison::compare(r.model, r.primary, *r.atlas, vessels.centreline_lps_mm);
  });
  if (!detail::isAnswer(r.primary) || (r.atlas && !comparable)) steps.leaveOut("uncertainty", "one of the runs is no answer");
  steps.run("uncertainty", [&](const Progress& p) {
    r.uncertainty = detail::uncertaintyOf(scene, inputs, cells, setup, r.atlas ? &atlasModel : nullptr, r, p);
    r.diagnostics.add(r.uncertainty->diagnostics);
  });
  if (r.difference) detail::tellOfSignificance(r);
  if (needs.pictures) {
    steps.run("liver-surface",
              [&](const Progress&) { r.picture = detail::retractionScene(scene, inputs, cells, r, vessels); });
  }
  if (!options.output.empty()) {
    detail::Writer writer(options.output, r.files);
    const FolderClaim claim(options.output);
    // The record comes last: without it, nobody takes what a killed run has left for a result, nor for a former one's.
    for (const char* name : {"run.json", "report.html", "report.pdf"}) std::filesystem::remove(options.output / name);
    steps.run("write-displacement-field", [&](const Progress&) { writer.displacementFields(r); });
    if (scene.outputs.vessels && needs.vessels) writer.vessels(scene, r, vessels);
    if (r.stiffness) writer.stiffness(*r.stiffness);
    if (needs.pictures) {
      const PictureData data = writer.pictureData(r);
      steps.run("picture-data", [&](const Progress&) { writer.pictureFile(data); });
      steps.run("slice-overlay", [&](const Progress&) {
        writer.sliceOverlays(data, options.palette);
        writer.charts(data);
      });
      try {
        steps.run("3d-overlay", [&](const Progress&) { writer.overlays3D(data, options.palette); });
      } catch (const RenderUnavailable& e) {
        // Everything but these pictures is there already; losing it for want of OpenGL would be worse than saying so.
        r.warnings.push_back(std::string("no 3-D picture was drawn: ") + e.what());
        steps.leaveOut("3d-overlay", "it cannot be drawn here");
      }
    }
    steps.run("sofa", [&](const Progress&) {
      const exchange::SofaExport node = exchange::writeSofa(options.output / "sofa", r.model, scene.setup,
                                                            {vessels.centreline_lps_mm, vessels.edges});
      r.files.insert(r.files.end(), node.files.begin(), node.files.end());
      for (const std::string& n : node.notes) r.warnings.push_back("SOFA: " + n);
      r.diagnostics.add(retraction::notExportable(scene.setup));
    });
    steps.run("report",
              [&](const Progress&) { writer.report(scene, r, detail::inputDigests(scene), options.palette); });
    r.json = detail::runRecord(scene, r, options.palette);
    r.files.insert(r.files.begin(), options.output / "run.json");
    writer.text("scene.json", detail::sceneSeenFrom(scene, options.output));
    writer.text("run.json", r.json + "\n");
  } else {
    r.json = detail::runRecord(scene, r, options.palette);
  }
  progress.report(1.0, "done");
  return r;
}

}  // namespace glisson::pipeline
