// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/step_works.h"

#include <future>

#include "base/error.h"
#include "elastography/statistics.h"
#include "pipeline/detail/build_model.h"
#include "pipeline/detail/told.h"
#include "pipeline/detail/uncertainty_step.h"
#include "retraction/offered.h"

namespace glisson::pipeline::detail {

bool RunState::allAnswer() const {
  return isAnswer(result.primary) && (!result.atlas || isAnswer(*result.atlas));
}

namespace works {
namespace {

/// The retraction of a body whose every modulus is 1/factor of the other's, nothing but clamps holding it: u ∝ 1/E.
/// Only for loads that do not depend on the stiffness and supports that are fixed at zero.
bool followsByScaling(const Scene& scene, const retraction::Model& model, const retraction::Model& atlas,
                      double& factor) {
  if (scene.setup.analysis.dynamic || Needs(scene).newton || Needs(scene).rigidBar) return false;
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
  if (isAnswer(large)) return retraction::gapBetween(model, linear, large, landmarks_mm);
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

/// Notes what linear theory misses of the scene's own answer, `linear` being that of linear theory.
void noteGap(const retraction::Model& model, const retraction::Result& linear,
             const std::vector<Eigen::Vector3d>& landmarks_mm, retraction::Result& answer) {
  if (!answer.solver.converged()) return;
  if (linear.solver.converged())
    answer.linearGap = retraction::gapBetween(model, linear, answer, landmarks_mm);
  else
    answer.linearGap.emplace().why = "linear theory has no answer here";
}

/// Both answers again in linear theory. Throws BadInput where it does not offer the scene.
LinearBeside linearAnswers(const RunState& s, const Progress& p) {
  const RunResult& r = s.result;
  const std::vector<Eigen::Vector3d>& probes_mm = s.scene.outputs.probes_mm;
  retraction::Setup setup = s.setup;
  setup.kinematics = retraction::Kinematics::Linear;
  LinearBeside linear;
  // At once only in contact: factors are made by BLAS, whose threads are one setting for the whole process.
  const std::launch when = s.needs.rigidBar ? std::launch::async : std::launch::deferred;
  std::future<retraction::Result> other;
  if (r.atlas && !sameStiffness(r.model, s.atlasModel))
    other = std::async(when, [&] { return retraction::simulate(s.atlasModel, setup, probes_mm, p); });
  linear.primary = retraction::simulate(r.model, setup, probes_mm, p);
  if (r.atlas) linear.atlas = other.valid() ? other.get() : linear.primary;
  return linear;
}

}  // namespace

void measureStiffness(RunState& s, const Progress&) {
  if (!s.inputs.stiffness || !s.inputs.roiOnMre)
    throw BadArgument("run: no elastogram or no region of interest was loaded");
  RunResult& r = s.result;
  elastography::MeasureOptions options;
  options.poisson = s.scene.setup.poisson;
  r.stiffness = elastography::measure(*s.inputs.stiffness, s.inputs.roiOnMre->mask, options);
  for (const std::string& w : r.stiffness->warnings) r.warnings.push_back(w);
  for (const Diagnostic& d : r.stiffness->diagnostics)
    if (d.severity() == Severity::Note) r.diagnostics.add(d.code, d.arguments);
}

void mesh(RunState& s, const Progress&) {
  RunResult& r = s.result;
  s.cells = dropLooseIslands(s.scene, bodyCells(s.scene, s.inputs), r.warnings);
  r.model = buildModel(s.scene, s.inputs, s.cells);
  r.model.smooth = smoothBody(s.scene, s.inputs);
  if (!s.compares()) return;
  s.atlasModel = buildAtlasModel(s.scene, s.cells);
  s.atlasModel.smooth = r.model.smooth;
}

void placeBar(RunState& s, const Progress& p) {
  RunResult& r = s.result;
  r.placed = retraction::placeBar(r.model, s.compares() ? &s.atlasModel : nullptr, s.setup, p);
  for (retraction::LoadSpec& load : s.setup.loads)
    if (auto* bar = std::get_if<retraction::Retractor>(&load)) *bar = r.placed->bar;
  if (!r.placed->bears) tellOfPlaces(r);
}

void findVessels(RunState& s, const Progress& p) {
  s.vessels = anatomy::findVessels(*s.inputs.mri, *s.inputs.liver, p);
  s.result.landmarks_mm = s.vessels.centreline_lps_mm;
}

void solve(RunState& s, const Progress& p) {
  // With a rigid bar nothing of the second answer waits for the first.
  if (s.needs.rigidBar && s.compares() && !sameStiffness(s.result.model, s.atlasModel))
    s.atlasAhead = std::async(std::launch::async, [&s, p] {
      return retraction::simulate(s.atlasModel, s.setup, s.scene.outputs.probes_mm, p);
    });
  s.result.primary = retraction::simulate(s.result.model, s.setup, s.scene.outputs.probes_mm, p);
}

void settleKinematics(RunState& s) {
  using retraction::Kinematics;
  RunResult& r = s.result;
  if (s.setup.kinematics == Kinematics::Auto && !s.needs.timeSteps && !r.primary.contact &&
      r.primary.kinematics == Kinematics::Linear) {
    retraction::judgeByGap(r.model, s.setup, r.landmarks_mm, r.primary);
    const bool linear = retraction::kinematicsValid(r.primary) && r.primary.linearTrusted;
    s.setup.kinematics = linear ? Kinematics::Linear : Kinematics::Hyperelastic;
    if (!linear && !retraction::largeDeformationRefusal(s.setup)) {
      const std::optional<retraction::LinearGap> missed = r.primary.linearGap;
      r.primary = retraction::simulate(r.model, s.setup, s.scene.outputs.probes_mm, s.log.here());
      r.primary.linearGap = missed;
    } else {
      s.setup.kinematics = Kinematics::Linear;
    }
  }
  r.kinematicsWhy = whyKinematics(s.scene, r.primary);
  r.warnings.insert(r.warnings.end(), r.primary.notes.begin(), r.primary.notes.end());
  r.diagnostics.add(r.primary.diagnostics);
  if (s.needs.meshfree) s.log.explain(StepId::MeshFreeFrames, framesInWords(s.scene.setup.model.meshfree, r.primary));
}

void takeAtlasShortcuts(RunState& s) {
  if (!s.compares()) return;
  RunResult& r = s.result;
  double factor = 1.0;
  if (sameStiffness(r.model, s.atlasModel)) {
    r.atlas = r.primary;
    s.log.leaveOut(StepId::AtlasSolve, "the material is the atlas itself: the second answer is the first");
  } else if (followsByScaling(s.scene, r.model, s.atlasModel, factor)) {
    r.atlas = retraction::scaled(s.atlasModel, s.setup, s.scene.outputs.probes_mm, r.primary, factor);
    s.log.leaveOut(StepId::AtlasSolve, "one modulus throughout and clamps only: displacement is proportional to 1/E");
  }
}

void solveAtlas(RunState& s, const Progress& p) {
  s.result.atlas = s.atlasAhead.valid() ? s.atlasAhead.get()
                                        : retraction::simulate(s.atlasModel, s.setup, s.scene.outputs.probes_mm, p);
}

void tellOfAtlas(RunState& s) {
  detail::tellOfAtlas(s.result);
}

void leaveOutEstimate(RunState& s) {
  if (!s.options.discretisation)
    s.log.leaveOut(StepId::DiscretisationError, "a study that measures errors itself does without the estimate");
}

void estimateDiscretisation(RunState& s, const Progress& p) {
  RunResult& r = s.result;
  if (!r.primary.solver.converged()) return;
  const bool both = r.atlas && r.atlas->solver.converged();
  const retraction::SecondAnswer second{s.atlasModel, both ? *r.atlas : r.primary};
  r.discretisation =
      retraction::discretisationError(r.model, s.setup, r.primary, p, both ? &second : nullptr, r.landmarks_mm);
  detail::tellOfDiscretisation(r);
}

void tellOfMissingPicture(RunState& s) {
  RunResult& r = s.result;
  if (!s.needs.pictures || !r.primary.drawable || !r.atlas || r.atlas->drawable) return;
  r.warnings.push_back("no picture is drawn, because of the atlas prediction: " +
                       (r.atlas->validity.empty() ? "it is no deformation" : r.atlas->validity.front()) +
                       (r.primary.contact ? "; choose another place, a smaller force or larger cells"
                                          : "; spread the load (\"spread_mm\" of the retractor), or choose another "
                                            "model or larger cells"));
}

void leaveOutLinearSolve(RunState& s) {
  if (!s.options.discretisation && !s.needs.report)
    s.log.leaveOut(StepId::LinearSolve, "a study that measures errors itself does without the estimate");
}

void solveInLinearTheory(RunState& s, const Progress& p) {
  RunResult& r = s.result;
  if (!r.primary.solver.converged() && !s.needs.report) return;
  LinearBeside linear;
  try {
    linear = linearAnswers(s, p);
  } catch (const BadInput& why) {
    const std::string none = std::string("linear theory does not offer this scene: ") + why.what();
    s.log.explain(StepId::LinearSolve, none);
    for (retraction::Result* answer : {&r.primary, r.atlas ? &*r.atlas : nullptr})
      if (answer && !answer->linearGap) answer->linearGap.emplace().why = none;
    return;
  }
  noteGap(r.model, linear.primary, r.landmarks_mm, r.primary);
  if (r.atlas) noteGap(s.atlasModel, *linear.atlas, r.landmarks_mm, *r.atlas);
  if (!s.needs.report || !linear.primary.solver.converged() || (linear.atlas && !linear.atlas->solver.converged()))
    return;
  linear.between = comparison::compare(r.model, r.primary, linear.primary, {});
  if (linear.atlas) linear.difference = comparison::compare(r.model, linear.primary, *linear.atlas, {});
  r.linear = std::move(linear);
}

void tellOfContact(RunState& s) {
  detail::tellOfContact(s.scene, s.result);
}

void leaveOutLinearGap(RunState& s) {
  if (!s.options.discretisation)
    s.log.leaveOut(StepId::LinearGap, "a study that measures errors itself does without the estimate");
}

void findLinearGap(RunState& s, const Progress& p) {
  RunResult& r = s.result;
  const double half = r.atlas ? 0.5 : 1.0;
  gapOf(r.model, s.setup, r.landmarks_mm, r.primary, p.part(0.0, half));
  if (!r.atlas) return;
  if (sameStiffness(r.model, s.atlasModel))
    r.atlas = r.primary;
  else
    gapOf(s.atlasModel, s.setup, r.landmarks_mm, *r.atlas, p.part(half, 1.0));
}

void withholdDifference(RunState& s) {
  if (!s.result.atlas || s.allAnswer()) return;
  withhold(s.result);
  s.log.leaveOut(StepId::Difference, "one of the two runs is no answer");
}

void compare(RunState& s, const Progress&) {
  RunResult& r = s.result;
  r.difference = comparison::compare(r.model, r.primary, *r.atlas, s.vessels.centreline_lps_mm);
}

void leaveOutUncertainty(RunState& s) {
  if (!s.allAnswer()) s.log.leaveOut(StepId::Uncertainty, "one of the runs is no answer");
}

void spreadUncertainty(RunState& s, const Progress& p) {
  RunResult& r = s.result;
  r.uncertainty =
      uncertaintyOf(s.scene, s.inputs, s.cells, s.setup, s.vessels, r.atlas ? &s.atlasModel : nullptr, r, p);
  r.diagnostics.add(r.uncertainty->diagnostics);
}

void tellOfSignificance(RunState& s) {
  if (s.result.difference) detail::tellOfSignificance(s.result);
}

void drawScene(RunState& s, const Progress&) {
  s.result.picture = retractionScene(s.scene, s.inputs, s.cells, s.result, s.vessels);
}

}  // namespace works
}  // namespace glisson::pipeline::detail
