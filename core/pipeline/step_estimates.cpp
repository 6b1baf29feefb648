// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/step_estimates.h"

#include <algorithm>

#include "mechanics/time_scheme.h"
#include "pipeline/detail/forecast.h"
#include "retraction/offered.h"

namespace glisson::pipeline::detail::estimates {
namespace {

/// Why the retractor is no rigid bar.
std::string patchInWords(const retraction::Setup& setup) {
  const auto refusal = retraction::patchTakenFor(setup);
  return "the retractor is a patch of pressure" +
         (refusal ? ": a rigid bar is not offered for " + retraction::inWords(*refusal, setup) : std::string());
}

/// Draws at every cell, of which the probability of 5 mm is made: 1,000 of each column.
double draws_s(const uncertainty::Options& asked, const Forecast& f) {
  return f.needs.compare ? 1.5e-6 * (asked.fields + 12) * f.cells : 0.0;
}

/// What "auto" does without a rigid bar.
std::string autoInWords(const retraction::Setup& setup) {
  const auto refusal = retraction::largeDeformationRefusal(setup);
  return refusal ? "it is not offered for " + retraction::inWords(*refusal, setup)
                 : "only if linear theory misses 0.2 mm or more, or strains leave it: then the scene is solved again";
}

/// The equations of the one solve.
std::string solveInWords(const Scene& s, const Needs& n) {
  if (n.rigidBar) {
    const bool travel = std::any_of(s.setup.loads.begin(), s.setup.loads.end(), [](const retraction::LoadSpec& load) {
      const auto* bar = std::get_if<retraction::Retractor>(&load);
      return bar != nullptr && bar->travel_mm;
    });
    return std::string("contact of bar and body: the bar is moved in steps on coarse cells until it has ") +
           (travel ? "its travel" : "its force") +
           ", then balance is found on the body's own cells, each time by Newton's method" +
           (s.setup.kinematics == retraction::Kinematics::Linear ? " (the body is linear, contact is not)" : "");
  }
  if (n.newton) return "balance in the deformed shape, by Newton's method";
  return "K u = f once";
}

}  // namespace

Estimate readMri(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.patient || n.mriValues,
          n.patient
              ? (n.mriValues ? "the contours lie on it; vessels and overlays show it" : "the contours lie on its grid")
              : (n.mriValues ? "the overlays need something to warp"
                             : "the body does not come from an image, and no picture is asked for"),
          n.patient ? 1.0 : 0.1, 100};
}

Estimate readRoi(const Forecast& f) {
  const GeometrySpec::Kind kind = f.scene.geometry.kind;
  return {f.needs.patient || kind == GeometrySpec::Kind::Mask,
          kind == GeometrySpec::Kind::Box ? "the body is a box" : "it outlines the body", 0.1, 20};
}

Estimate readMre(const Forecast& f) {
  return {f.needs.mre, f.needs.mre ? "the stiffness comes from it" : "the material is not \"mre\"", 0.5, 20};
}

Estimate measureStiffness(const Forecast& f) {
  return {f.needs.mre,
          f.needs.mre ? "statistics of the region of interest go into the record" : "no elastogram is used", 0.05};
}

Estimate readMap(const Forecast& f) {
  return {f.needs.map, f.needs.map ? "the modulus of each voxel comes from it" : "the material is not a map", 0.1};
}

Estimate vessels(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.vessels,
          n.vessels   ? "they are the landmarks that are compared"
          : n.patient ? "neither vessels nor pictures are asked for"
                      : "there is no contrast-enhanced image to find them in",
          6.0, 300};
}

Estimate liverSurface(const Forecast& f) {
  const bool needed = f.needs.liverSurface;
  return {needed, needed ? "the 3-D picture shows it" : "no picture is asked for", 1.0, 50};
}

Estimate mesh(const Forecast& f) {
  return {true,
          "about " + std::to_string(static_cast<long long>(f.cells)) + " cells, " +
              std::to_string(static_cast<long long>(f.dofs)) + " degrees of freedom",
          0.1, 40e-6 * f.cells};
}

Estimate placeBar(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.rigidBar,
          n.rigidBar
              ? "the first place on the lower right lobe that both stiffnesses bear, or the one that the scene gives"
          : n.retractor ? patchInWords(f.scene.setup)
                        : "there is no retractor",
          2 * f.solve_s, 0.2 * f.solve_MB};
}

Estimate capsule(const Forecast& f) {
  const bool bar = f.needs.rigidBar;
  const auto& capsule = f.scene.setup.capsule;
  return {bar && capsule.has_value(),
          !bar ? "there is no rigid bar that would fold the surface"
          : capsule && capsule->form == retraction::CapsuleForm::Cells
              ? "Glisson's capsule stiffens a layer of 3 mm below the surface, in all directions"
          : capsule ? "Glisson's capsule carries tension along the surface"
                    : "the scene leaves it out, or the body is no liver"};
}

Estimate ligaments(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.ligaments,
          n.ligaments ? "the scene says where they are attached: fibres that pull and turn"
          : n.patient ? "the scene names none: images show neither where they are attached nor where they spring from"
                      : "the scene names none"};
}

Estimate loadsThatFollow(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.followingLoads && n.newton,
          !n.followingLoads ? "no load follows its faces (\"follows\")"
          : n.newton        ? "their direction and area are those of the deformed faces, in every iteration"
                            : "in linear theory faces neither turn nor grow"};
}

Estimate assembledStiffnessMatrix(const Forecast& f) {
  return {f.assembled, f.tetrahedra     ? "tetrahedra have no common shape: their matrix is put together"
                       : f.needs.newton ? "the tangent changes with every iteration: it is put together anew"
                       : f.assembled    ? "the scene asks for a factorisation"
                                        : "one modulus per voxel is enough: K is applied, not stored"};
}

Estimate meshFreeFrames(const Forecast& f) {
  return {f.needs.meshfree,
          f.needs.meshfree ? f.frames.why
          : f.tetrahedra   ? "the model is tetrahedra"
                           : "the model is voxel finite elements",
          2.0, 100};
}

Estimate massMatrix(const Forecast& f) {
  const bool needed = f.needs.mass;
  return {needed, needed ? "the analysis is dynamic" : "the analysis is static: inertia plays no part", 0.1};
}

Estimate damping(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.damping, n.damping     ? "Rayleigh damping is given"
                     : n.timeSteps ? "both Rayleigh coefficients are 0"
                                   : "the analysis is static"};
}

Estimate solve(const Forecast& f) {
  const bool steps = f.needs.timeSteps;
  return {!steps, steps ? "the time steps lead to the answer" : solveInWords(f.scene, f.needs), f.solve_s, f.solve_MB};
}

Estimate timeSteps(const Forecast& f) {
  const auto& analysis = f.scene.setup.analysis;
  return {f.needs.timeSteps,
          f.needs.timeSteps ? mechanics::nameOf(analysis.scheme) + (" to " + std::to_string(analysis.end_s)) + " s"
                            : "only the steady state is asked for",
          f.solve_s * analysis.end_s * 1e3 / analysis.h_ms, f.solve_MB};
}

Estimate largeDeformation(const Forecast& f) {
  const bool needed = f.needs.newton;
  const bool automatic = f.scene.setup.kinematics == retraction::Kinematics::Auto;
  return {needed,
          needed && automatic && !f.needs.rigidBar ? "supports that act one way only are beyond linear theory"
          : needed && automatic
              ? "a rigid bar is followed in large deformation: what linear theory would miss is known only once "
                "that answer is there, so \"auto\" does not fall back to it"
          : needed    ? "the kinematics are not linear"
          : automatic ? autoInWords(f.scene.setup)
                      : "the kinematics are linear",
          10 * f.solve_s, 2 * f.solve_MB};
}

Estimate linearSolve(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.linearBeside,
          n.linearBeside ? (n.report ? "the report shows beside the answer what linear theory would have said"
                                     : "what linear theory misses is said of every answer")
          : n.newton     ? "the analysis is dynamic"
                         : "the answer is the linear one",
          f.answers * f.solve_s, f.solve_MB};
}

Estimate condensedResponse(const Forecast& f) {
  const bool needed = f.needs.condensed;
  return {needed, needed ? "the solver is \"condensed\"" : "one load case: a response matrix would not pay"};
}

Estimate atlasSolve(const Forecast& f) {
  return {f.needs.compare,
          f.needs.compare ? "the same load on the textbook stiffness; left out where the answer follows from the first"
                          : "no comparison is asked for",
          f.solve_s, f.solve_MB};
}

Estimate discretisationError(const Forecast& f) {
  const Needs& n = f.needs;
  const double solves = n.meshfree ? 1.2 : n.newton ? 1.5 : 0.15;
  return {n.discretisation,
          !n.discretisation ? "estimated for static answers only"
          : n.compare       ? "the answers and their difference say how far their cells let them be believed: both "
                              "again on cells of twice the edge"
                            : "the answer says how far its cells let it be believed: a second solve on cells of twice "
                              "the edge",
          f.answers * solves * f.solve_s, f.solve_MB / 8};
}

Estimate difference(const Forecast& f) {
  const bool needed = f.needs.compare;
  return {needed, needed ? "how far apart the two place the same tissue" : "no comparison is asked for", 0.01};
}

Estimate uncertainty(const Forecast& f) {
  const bool needed = f.needs.uncertainty;
  const auto& asked = f.scene.uncertainty;
  return {needed,
          needed  ? "asked for: every source through the tangent of both answers, and some draws in full"
          : asked ? "asked for, and offered for a rigid bar only"
                  : "not asked for (\"uncertainty\")",
          asked ? f.answers * (0.1 * (asked->fields + 12) + asked->checks) * f.solve_s + draws_s(*asked, f) : 0.0,
          2.0 * f.solve_MB};
}

Estimate linearGap(const Forecast& f) {
  const Needs& n = f.needs;
  // On cells so large that the tangent, 0.7 kB for each degree of freedom, stays below 42 MB.
  return {!n.newton,
          n.newton     ? "the kinematics are not linear: \"linear-solve\" says what they add"
          : n.rigidBar ? "the same bar in large deformation says what linear theory misses"
                       : "one corotational correction says what linear theory misses",
          f.answers * (n.rigidBar ? 10.0 : 0.4) * f.solve_s,
          n.rigidBar ? 2 * f.solve_MB : std::min(60.0, 0.7e-3 * 3.3 * f.body.voxels)};
}

Estimate strain(const Forecast& f) {
  return {f.needs.strain, "every result says whether linear theory can be trusted", 1e-7 * f.cells};
}

Estimate cellDisplacements(const Forecast& f) {
  const bool needed = f.needs.cellField;
  return {needed, needed ? "overlays, comparison or the field itself need them" : "only probes and sums are asked for",
          1e-8 * f.cells};
}

Estimate writeDisplacementField(const Forecast& f) {
  const bool needed = f.scene.outputs.displacementField;
  return {needed, needed ? "asked for" : "not asked for", 0.1};
}

Estimate pictureData(const Forecast& f) {
  const bool needed = f.needs.pictures;
  return {needed,
          needed ? "what the pictures show is kept, so that \"render\" can draw it again" : "no picture is asked for",
          0.1};
}

Estimate sliceOverlay(const Forecast& f) {
  return {f.needs.pictures, f.needs.pictures ? "asked for" : "no picture is asked for", 1.0, 50};
}

Estimate overlay3D(const Forecast& f) {
  const bool needed = f.needs.pictures;
  return {needed, needed ? "asked for" : "no picture is asked for: no OpenGL is started", 4.0, 200};
}

Estimate uncertaintyPictures(const Forecast& f) {
  const Needs& n = f.needs;
  return {n.pictures && n.uncertainty,
          !n.pictures      ? "no picture is asked for"
          : !n.uncertainty ? "the run does not say how sure it is: there is nothing to show"
          : n.compare      ? "sources in mm, vessels with what holds them, and a map of the probability of 5 mm"
                           : "sources in mm, and vessels with what holds them; one answer has no probability of 5 mm",
          3.0, 200};
}

Estimate report(const Forecast& f) {
  return {f.needs.report, f.needs.report ? "asked for" : "not asked for", 0.2};
}

Estimate sofa(const Forecast& f) {
  return {f.needs.sofa, f.needs.sofa ? "asked for: the patient's node as a scene for SOFA" : "not asked for"};
}

}  // namespace glisson::pipeline::detail::estimates
