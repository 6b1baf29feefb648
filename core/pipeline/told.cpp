// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/told.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "pipeline/detail/needs.h"
#include "pipeline/detail/record.h"
#include "retraction/offered.h"

namespace glisson::pipeline {
namespace {

using detail::Needs;

std::string wordOf(bool atlas) {
  return atlas ? "atlas" : "own";
}

const retraction::Retractor* barOf(const Scene& scene) {
  for (const retraction::LoadSpec& load : scene.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load)) return bar;
  return nullptr;
}

struct Plausible {
  double least, most;
};

void tellImplausible(const char* what, double value, const char* unit, Plausible range, const char* usually,
                     Diagnostics& said) {
  if (value >= range.least && value <= range.most) return;
  said.add(
      DiagnosticCode::ValueImplausible,
      {{"what", std::string(what)}, {"value", value}, {"unit", std::string(unit)}, {"usually", std::string(usually)}});
}

/// Numbers that can be computed with, and are most likely mistyped or in another unit. A box may be of any material, an
/// organ is of tissue.
void tellOfImplausible(const Scene& scene, Diagnostics& said) {
  const bool organ = scene.geometry.kind != GeometrySpec::Kind::Box;
  const retraction::Setup& s = scene.setup;
  tellImplausible("the density", s.density.kgPerM3(), "kg/m3", organ ? Plausible{500, 1500} : Plausible{100, 25000},
                  organ ? "soft tissue has (about 1060 kg/m3)" : "solids have", said);
  const Plausible modulus = organ ? Plausible{0.1, 1000} : Plausible{1e-3, 1e9};
  const char* usual = organ ? "a liver has (some 1 to 100 kPa)" : "solids have";
  if (scene.material.kind == MaterialSpec::Kind::Uniform)
    tellImplausible("the stiffness", scene.material.value_kPa, "kPa", modulus, usual, said);
  if (scene.compare)
    tellImplausible("the stiffness to compare with", scene.compare->value_kPa, "kPa", modulus, usual, said);
  if (organ && s.poisson >= 0.0)
    tellImplausible("Poisson's ratio", s.poisson, "(no unit)", {0.3, 0.5}, "soft tissue has (.45 to .499)", said);
  for (const retraction::LoadSpec& load : s.loads) {
    const auto* bar = std::get_if<retraction::Retractor>(&load);
    if (bar == nullptr || !organ) continue;
    tellImplausible("the bar's diameter", bar->diameter_mm, "mm", {3, 40}, "retractors have (about 10 mm)", said);
    tellImplausible("the bar's length", bar->length_mm, "mm", {10, 200}, "retractors have (about 80 mm)", said);
    if (bar->force_N)
      tellImplausible("the bar's force", *bar->force_N, "N", {0.1, 100}, "retracts a liver (its weight is some 15 N)",
                      said);
    if (bar->travel_mm)
      tellImplausible("the bar's travel", std::abs(*bar->travel_mm), "mm", {0.1, 150}, "a liver is moved by", said);
  }
}

/// What of a scene its model and its kinematics pass over.
void tellOfUnused(const Scene& scene, const Needs& needs, Diagnostics& said) {
  const retraction::Setup& s = scene.setup;
  const auto unused = [&](const char* key, const char* why) {
    said.add(DiagnosticCode::SettingNotUsed, {{"key", std::string(key)}, {"why", std::string(why)}});
  };
  if (needs.rigidBar && scene.names("spread_mm"))
    unused("spread_mm", "the retractor is a rigid bar, whose pressure is found and not given");
  const retraction::Retractor* bar = barOf(scene);
  if (bar != nullptr && !needs.rigidBar && (scene.names("shape") || bar->shape == retraction::BarShape::Hook))
    unused("shape", "a patch of pressure has none but that of the straight bar");
  if (needs.rigidBar && scene.names("model.element"))
    unused("model.element", "contact has mean-dilatation hexahedra of its own");
  if (s.law && (s.kinematics == retraction::Kinematics::Linear || s.kinematics == retraction::Kinematics::Corotational))
    unused("material.law", "these kinematics have a linear law");
  if (!retraction::inLargeDeformation(s)) return;
  constexpr const char* own =
      "large deformation and contact have a solver of their own, Newton's method with multigrid";
  if (s.solver.kind != mechanics::SolverKind::Auto) unused("solver.kind", own);
  if (s.solver.iterations != 0) unused("solver.iterations", own);
  if (scene.names("solver.preconditioner")) unused("solver.preconditioner", own);
  if (needs.rigidBar && scene.names("solver.tolerance") && s.solver.tolerance < 1e-6)
    unused("solver.tolerance", "contact is solved to 1e-6 at best");
}

}  // namespace

Diagnostics toldOf(const Scene& scene) {
  const Needs needs(scene);
  Diagnostics said;
  tellOfImplausible(scene, said);
  if (scene.setup.poisson < 0.0) said.add(DiagnosticCode::PoissonNegative, {{"poisson", scene.setup.poisson}});
  if (const auto refusal = retraction::patchTakenFor(scene.setup))
    said.add(DiagnosticCode::PatchTaken,
             {{"refuses", retraction::nameOf(*refusal)}, {"what", retraction::inWords(*refusal, scene.setup)}});
  if (scene.capsuleAsked && scene.setup.capsule && !needs.rigidBar)
    said.add(DiagnosticCode::CapsuleNotUsed,
             {{"instead",
               std::string(needs.retractor ? "the retractor is a patch of pressure" : "the scene has no retractor")}});
  if (scene.uncertainty && !needs.uncertainty)
    said.add(DiagnosticCode::UncertaintyNotOffered,
             {{"instead",
               std::string(needs.retractor ? "the retractor is a patch of pressure" : "the scene has no retractor")}});
  tellOfUnused(scene, needs, said);
  return said;
}

namespace detail {

std::string whyKinematics(const Scene& scene, const retraction::Result& r) {
  if (scene.setup.kinematics != retraction::Kinematics::Auto) return "the scene asks for them";
  if (r.contact)
    return "a rigid bar is followed in large deformation: what linear theory would miss is known only once that answer "
           "is there, and then it is the better one";
  if (retraction::inLargeDeformation(scene.setup)) return "supports that act one way only are beyond linear theory";
  if (r.kinematics == retraction::Kinematics::Hyperelastic)
    return "linear theory misses 0.2 mm or more, or strains leave it";
  if (r.linearGap && retraction::kinematicsValid(r)) return "linear theory misses less than 0.2 mm";
  const auto refusal = retraction::largeDeformationRefusal(scene.setup);
  return refusal ? "large deformation is not offered for " + retraction::inWords(*refusal, scene.setup)
                 : "what linear theory misses is not known";
}

void tellOfPlaces(RunResult& r) {
  double best = 0.0;
  for (const auto& t : r.placed->tried) best = std::max(best, t.borne);
  r.diagnostics.add(DiagnosticCode::NoPlaceBears,
                    {{"places", static_cast<std::int64_t>(r.placed->tried.size())}, {"percent", 100.0 * best}});
}

namespace {

/// What is said of an answer and stands among the run's own diagnostics too, with its stiffness.
bool isOfRun(DiagnosticCode code) {
  return code == DiagnosticCode::RetractorPastLimit || code == DiagnosticCode::RetractorJumps ||
         code == DiagnosticCode::CellsCrushed || Diagnostic{code, {}}.severity() == Severity::Error;
}

}  // namespace

void tellOfContact(const Scene& scene, RunResult& r) {
  for (const bool atlas : {false, true}) {
    if (atlas && !r.atlas) continue;
    for (Diagnostic d : (atlas ? *r.atlas : r.primary).doubts) {
      if (!isOfRun(d.code)) continue;
      for (auto& [key, value] : d.arguments)
        if (key == "stiffness") value = wordOf(atlas);  // where both are the same, the second answer is the first
      r.diagnostics.add(d.code, d.arguments);
    }
  }
  if (!r.primary.contact) return;
  const retraction::RigidContact& c = *r.primary.contact;
  r.diagnostics.add(DiagnosticCode::ContactByCells, {{"cell_mm", r.model.youngs_kPa.grid.spacing_mm.maxCoeff()}});
  // The placed bar's point is its axis on a smooth body: what counts is how far from the scene's own point it touches.
  for (const retraction::LoadSpec& load : scene.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load); bar && bar->at_mm && r.placed) {
      const double moved_mm = c.moved_mm + (*r.placed->bar.at_mm - *bar->at_mm).dot(c.hoist);
      if (std::abs(moved_mm) > c.barRadius_mm)
        r.diagnostics.add(DiagnosticCode::RetractorLaid, {{"distance_mm", std::abs(moved_mm)},
                                                          {"side", std::string(moved_mm < 0 ? "before" : "beyond")}});
    }
}

void tellOfAtlas(RunResult& r) {
  if (!r.atlas) return;
  if (r.atlas->contact)
    for (const Diagnostic& d : r.atlas->doubts)
      if (!isOfRun(d.code)) r.warnings.push_back("atlas: " + d.text());
  for (const std::string& w : r.atlas->solver.diagnostics.texts(Severity::Warning)) r.warnings.push_back("atlas: " + w);
}

namespace {

const char* inWords(mechanics::ContactOutcome outcome) {
  switch (outcome) {
    case mechanics::ContactOutcome::Slips: return "slips";
    case mechanics::ContactOutcome::Folds: return "folds";
    case mechanics::ContactOutcome::Cuts: return "cuts";
    case mechanics::ContactOutcome::LoadsNotBorne: return "loads not borne";
    case mechanics::ContactOutcome::Reached:
    case mechanics::ContactOutcome::Stopped: break;
  }
  return "not converged";
}

}  // namespace

bool isAnswer(const retraction::Result& result) {
  if (!result.solver.converged()) return false;
  if (result.kinematics != retraction::Kinematics::Linear) return result.drawable;
  return !result.contact || result.contact->smallestJ > 0;
}

namespace {

/// Why a result is no answer, in a few words.
std::string whyNone(const retraction::Result& r) {
  if (!r.solver.converged()) return r.contact ? inWords(r.contact->outcome) : "not converged";
  for (const Diagnostic& d : r.doubts)
    if (d.code == DiagnosticCode::DisplacementBeyondBody) return "it moves the body by more than its size";
  return "a cell is turned inside out";
}

}  // namespace

void withhold(RunResult& r) {
  for (const bool atlas : {false, true}) {
    const retraction::Result& result = atlas ? *r.atlas : r.primary;
    if (isAnswer(result)) continue;
    r.diagnostics.add(DiagnosticCode::DifferenceWithheld, {{"stiffness", wordOf(atlas)}, {"reason", whyNone(result)}});
  }
}

namespace {

/// Whether the estimated error of the cells reaches over the clinical line.
bool cellsReachTheLine(const RunResult& r) {
  if (!r.discretisation || !r.discretisation->difference) return false;
  const std::optional<double> error_mm = r.discretisation->difference->at_retractor_mm;
  return error_mm && std::abs(r.difference->at_retractor_mm - defaults::clinicallySignificant.mm()) <= *error_mm;
}

/// Whether the 95 % interval of what is uncertain about the patient holds the clinical line.
bool intervalHoldsTheLine(const RunResult& r) {
  if (!r.uncertainty || !r.uncertainty->known || !r.uncertainty->spread.headline) return false;
  const uncertainty::Interval& interval = r.uncertainty->spread.headline->at_retractor_mm;
  const double line_mm = defaults::clinicallySignificant.mm();
  return interval.low <= line_mm && line_mm <= interval.high;
}

}  // namespace

void tellOfSignificance(RunResult& r) {
  if (significanceOf(r) != Significance::Open || !cellsReachTheLine(r)) return;  // an interval speaks for itself
  r.diagnostics.add(DiagnosticCode::SignificanceOpen, {{"at_retractor_mm", r.difference->at_retractor_mm},
                                                       {"line_mm", defaults::clinicallySignificant.mm()},
                                                       {"error_mm", *r.discretisation->difference->at_retractor_mm}});
}

void tellOfDiscretisation(RunResult& r) {
  constexpr double clinically_mm = 1.0, share = 0.2;  // of the displacement: both have to be passed
  if (!r.discretisation || !r.discretisation->known || !isAnswer(r.primary)) return;
  const retraction::DiscretisationError& e = *r.discretisation;
  struct Place {
    const char* where;
    double error_mm, displacement_mm;
    double share() const { return error_mm / std::max(displacement_mm, 1e-9); }
  };
  const Motion motion = motionOf(r.model, r.primary);
  std::vector<Place> places = {{"somewhere in the body", e.p95_mm, motion.max_mm}};
  if (e.at_retractor_mm && motion.at_retractor_mm > 0.0)
    places.push_back({"at the retractor", *e.at_retractor_mm, motion.at_retractor_mm});
  if (e.vesselsMax_mm) places.push_back({"at a vessel", *e.vesselsMax_mm, motion.max_mm});
  const Place& worst = *std::max_element(places.begin(), places.end(),
                                         [](const Place& a, const Place& b) { return a.share() < b.share(); });
  if (worst.error_mm < clinically_mm || worst.share() < share) return;
  r.diagnostics.add(DiagnosticCode::DiscretisationLarge, {{"cell_mm", e.cell_mm},
                                                          {"error_mm", worst.error_mm},
                                                          {"displacement_mm", worst.displacement_mm},
                                                          {"where", std::string(worst.where)}});
}

std::string adviceOn(const Scene& scene, const RunResult& r) {
  const std::string own = adviceOn(scene, r.primary);
  return own.empty() && r.atlas ? adviceOn(scene, *r.atlas) : own;
}

std::string adviceOn(const Scene& scene, const retraction::Result& r) {
  if (r.kinematics != retraction::Kinematics::Linear || r.linearTrusted || !r.solver.converged()) return {};
  const bool offered = !retraction::largeDeformationRefusal(scene.setup);
  std::string way = retraction::wayToLargeDeformation(scene.setup);
  way.front() = 'T';  // "take ..."
  const std::string hyperelastic = offered ? "Choose \"kinematics\": \"hyperelastic\"" : way;
  if (r.p95_strain >= 0.10)
    return hyperelastic +
           ". Linear theory adds up strains as if they were small and keeps the "
           "stiffness and the shape on which the load acts as they are at rest; the hyperelastic (neo-Hookean) body is "
           "solved in its deformed shape and stiffens as it is compressed. Displacements at the retractor change most. "
           "The report then shows both answers side by side.";
  if (r.max_rotation_deg >= 15 && offered && !r.contact)
    return "Choose \"kinematics\": \"corotational\". Linear theory takes rotation for strain; corotational elements "
           "turn with the material and strain it only by what is left. Where the tissue turns, it no longer swells, "
           "and displacements there change. The report then shows both answers side by side.";
  return hyperelastic + (r.max_rotation_deg >= 15 && r.drawable
                             ? ": linear theory takes rotation for strain, and this body turns."
                             : ": the linear answer is no deformation of this body.");
}

}  // namespace detail

Significance significanceOf(const RunResult& r) {
  if (detail::cellsReachTheLine(r) || detail::intervalHoldsTheLine(r)) return Significance::Open;
  return r.difference->clinically_significant ? Significance::Beyond : Significance::Below;
}

}  // namespace glisson::pipeline
