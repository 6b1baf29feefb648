// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/simulate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "mechanics/dynamics.h"
#include "mechanics/measures.h"
#include "mechanics/meshfree.h"
#include "mechanics/newton_solve.h"
#include "mechanics/static_solve.h"
#include "mechanics/tet_faces.h"
#include "mechanics/tet_solve.h"
#include "retraction/body.h"
#include "retraction/condensed_solve.h"
#include "retraction/delaunay_solve.h"
#include "retraction/detail/bar_doubts.h"
#include "retraction/rigid_contact.h"
#include "retraction/smooth_body.h"

namespace glisson::retraction {
namespace {

constexpr double mToMm = 1e3;

/// What the solvers give back, whatever the model.
struct Answer {
  mechanics::Solution solution;
  int dofs = 0;
  int frames = 0;
  int steps = 0;
  std::vector<std::string> notes;
  Diagnostics diagnostics;
  std::optional<RigidContact> contact;
  Eigen::Vector3d following_N = Eigen::Vector3d::Zero();  ///< LPS
  std::vector<LigamentPull> ligaments;
  bool loadsBorne = true;
  bool useless = false;             ///< the model cannot deform as this body does
  std::vector<std::string> limits;  ///< what the mesh-free model could not give as asked for

  void take(LargeDeformationAnswer large) {
    solution = std::move(large.solution);
    following_N = large.following_N;
    ligaments = std::move(large.ligaments);
    diagnostics.add(large.diagnostics);
    loadsBorne = large.loadsBorne;
  }
};

mechanics::DynamicOptions dynamicOptions(const AnalysisSpec& a) {
  mechanics::DynamicOptions d;
  d.h_s = 1e-3 * a.h_ms;
  d.end_s = a.end_s;
  d.scheme = a.scheme;
  d.spectralRadius = a.spectralRadius;
  d.rayleighAlpha_1_s = a.rayleigh[0];
  d.rayleighBeta_s = a.rayleigh[1];
  d.stopWhenSteady = a.stopWhenSteady;
  return d;
}

/// What a reader of the last state of a motion should know.
void noteMotion(const AnalysisSpec& a, int steps, bool steady, std::vector<std::string>& notes) {
  const mechanics::TimeSteps plan = mechanics::timeSteps(1e-3 * a.h_ms, a.end_s);
  Diagnostics said;
  if (plan.h_s < 1e-3 * a.h_ms)
    said.add(
        DiagnosticCode::TimeStepShortened,
        {{"asked_ms", a.h_ms}, {"taken_ms", 1e3 * plan.h_s}, {"steps", std::int64_t{plan.count}}, {"end_s", a.end_s}});
  if (a.stopWhenSteady > 0.0 && !steady) said.add(DiagnosticCode::MotionNotAtRest, {{"seconds", steps * plan.h_s}});
  for (std::string& text : said.texts()) notes.push_back(std::move(text));
}

/// Nothing that a scene asks for is passed over in silence.
void requireOffered(const Setup& setup) {
  const bool linear = setup.kinematics == Kinematics::Linear || setup.kinematics == Kinematics::Auto;
  const std::string kinematics = setup.kinematics == Kinematics::Corotational ? "corotational" : "hyperelastic";
  if (!linear && setup.model.kind != ModelKind::FemHex)
    throw BadInput("kinematics \"" + kinematics + "\" is offered for the model \"fem-hex\" only; this scene asks for " +
                   (setup.model.kind == ModelKind::FemTet ? "\"fem-tet\"" : "\"meshfree\"") +
                   ": change the model, or use linear kinematics");
  if (!linear && setup.analysis.dynamic)
    throw BadInput("kinematics \"" + kinematics +
                   "\" is offered for the static analysis only: make the analysis static, or the kinematics linear");
  if (!linear && setup.condensed)
    throw BadInput("a condensed response is linear, and kinematics \"" + kinematics +
                   "\" is not: choose another solver, or linear kinematics");
  if (setup.condensed && setup.analysis.dynamic && setup.analysis.scheme != mechanics::TimeScheme::ImplicitEuler)
    throw BadInput(std::string("condensed motion takes implicit Euler steps, and the scene asks for \"") +
                   mechanics::nameOf(setup.analysis.scheme) + "\": choose another solver, or leave \"scheme\" out");
  if (setup.model.kind == ModelKind::FemTet && setup.analysis.dynamic)
    throw BadInput("the model \"fem-tet\" is offered for the static analysis only: use \"fem-hex\" or \"meshfree\"");
  if (setup.model.kind != ModelKind::FemHex && setup.condensed)
    throw BadInput("condensed responses are made from voxels: use the model \"fem-hex\"");
}

Answer solveOnTets(const Model& model, const Body& body, const MechanicsScene& scene, const Setup& setup,
                   const Progress& progress) {
  Answer a;
  if (setup.model.delaunay) {
    DelaunayAnswer d = solveOnDelaunay(model, body, scene, setup, progress);
    a.solution = std::move(d.solution);
    a.dofs = d.dofs;
    a.notes.push_back(std::move(d.note));
    return a;
  }
  const auto order = setup.model.quadraticTets ? mechanics::TetOrder::Quadratic : mechanics::TetOrder::Linear;
  mechanics::TetProblem tets = mechanics::onTetrahedra(scene.problem, order);
  if (setup.model.quadraticTets) mechanics::layFoundations(tets, body.mesh(), scene.foundations);
  const mechanics::VoxelFacesOnTets faces(body.mesh(), tets.mesh);
  tets.f_N.setZero();
  for (std::size_t i = 0; i < setup.loads.size(); ++i) {
    if (const auto* load = std::get_if<BodyForce>(&setup.loads[i]))
      tets.f_N += mechanics::bodyForce(tets.mesh, body.vectorToLocal(load->N_per_m3));
    for (const FaceTraction& t : scene.tractions[i])
      for (const auto& [node, share] : faces.shares(t.face))
        tets.f_N.col(node) += share * mechanics::faceArea_m2(body.mesh(), t.face.side) * t.traction_Pa;
  }
  a.solution = mechanics::solveTets(scene.problem, tets, setup.solver, progress);
  a.dofs = 3 * tets.mesh.nodeCount();
  a.notes.push_back(std::to_string(tets.mesh.tetCount()) + (setup.model.quadraticTets ? " quadratic" : " linear") +
                    " tetrahedra, six per voxel");
  return a;
}

Answer solve(const Model& patient, const Body& body, const MechanicsScene& scene, const Setup& setup,
             const Progress& progress) {
  if (setup.model.kind == ModelKind::FemTet) return solveOnTets(patient, body, scene, setup, progress);
  const mechanics::Problem& problem = scene.problem;
  Answer a;
  mechanics::SolverOptions options = setup.solver;
  options.element = setup.model.element;
  if (setup.model.kind == ModelKind::Meshfree) {
    const mechanics::MeshfreeModel model(problem, setup.model.meshfree, setup.model.element, progress.part(0.0, 0.5));
    a.dofs = model.dofs();
    a.frames = model.frames();
    a.notes = model.notes();
    a.limits = model.basis().notes();
    a.useless = model.basis().flatShare() > 0.5;
    if (setup.analysis.dynamic) {
      mechanics::DynamicSolution d =
          mechanics::solveDynamic(model, dynamicOptions(setup.analysis), options, progress.part(0.5, 1.0));
      a.steps = d.trajectory.steps;
      a.solution = std::move(d.solution);
      noteMotion(setup.analysis, a.steps, d.trajectory.steady, a.notes);
    } else {
      a.solution = model.solveStatic(options, progress.part(0.5, 1.0));
    }
    return a;
  }
  if (setup.condensed) {
    CondensedAnswer c = solveCondensed(problem, scene.loads_N, setup, progress);
    a.solution = std::move(c.solution);
    a.steps = c.steps;
    if (setup.analysis.dynamic) {
      noteMotion(setup.analysis, c.steps, c.steady, a.notes);
      a.notes.push_back(Diagnostic{DiagnosticCode::CondensedMotionError, {{"error_mm", c.error_mm}}}.text());
    }
  } else if (setup.kinematics != Kinematics::Linear) {
    if (setup.kinematics == Kinematics::Corotational) {
      a.solution =
          mechanics::solveLargeDeformation(problem, mechanics::LargeDeformationKind::Corotational, options, progress);
    } else {
      a.take(solveWithoutBar(body, setup, scene, options.tolerance, progress));
      a.diagnostics.add(DiagnosticCode::ElementChosen);
    }
  } else if (setup.analysis.dynamic) {
    mechanics::DynamicSolution d = mechanics::solveDynamic(problem, dynamicOptions(setup.analysis), options, progress);
    a.steps = d.trajectory.steps;
    a.solution = std::move(d.solution);
    noteMotion(setup.analysis, a.steps, d.trajectory.steady, a.notes);
  } else {
    a.solution = mechanics::solveStatic(problem, options, progress);
  }
  a.dofs = static_cast<int>(3 * a.solution.u_m.cols());
  return a;
}

image::DisplacementField atCellCentres(const Body& body, const image::Grid& grid, const mechanics::NodalField& u_m) {
  image::DisplacementField field(grid, Eigen::Vector3f::Zero());
  for (int cell = 0; cell < body.mesh().cellCount(); ++cell) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : body.mesh().nodesOf(cell)) sum += u_m.col(node);
    field.at(body.mesh().cellOf(cell)) = body.vectorToLps(mToMm * sum / 8.0).cast<float>();
  }
  return field;
}

std::vector<Eigen::Vector3d> interpolate(const Body& body, const mechanics::NodalField& u_m,
                                         const std::vector<Eigen::Vector3d>& points_mm) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) {
    const auto u = mechanics::displacementAt(body.mesh(), u_m, body.toLocal_m(p));
    out.push_back(u ? body.vectorToLps(mToMm * *u)
                    : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).eval());
  }
  return out;
}

/// Share of each cell of the body that lies inside the smooth one.
std::vector<float> coveredOf(const Model& model, const Body& body) {
  std::vector<float> covered;
  const image::ScalarVolume fraction = model.smooth->fractions(model.youngs_kPa.grid);
  const Eigen::Vector3i layers = (fraction.grid.size - model.youngs_kPa.grid.size) / 2;
  for (int cell = 0; cell < body.mesh().cellCount(); ++cell)
    covered.push_back(fraction.at(body.mesh().cellOf(cell) + layers));
  return covered;
}

/// The figures of strain and rotation. With a rigid bar on a smooth body only of cells that hold enough tissue.
mechanics::DeformationSummary measured(const Model& model, const Body& body, const mechanics::NodalField& u_m,
                                       Result& r) {
  const bool linear = r.kinematics == Kinematics::Linear;
  const mechanics::CellMeasures cells = mechanics::measureCells(
      body.mesh(), u_m, linear ? mechanics::StrainMeasure::Small : mechanics::StrainMeasure::Biot);
  const mechanics::DeformationSummary m = r.contact && model.smooth
                                              ? mechanics::summarise(cells, u_m, coveredOf(model, body))
                                              : mechanics::summarise(cells, u_m);
  r.max_displacement_mm = mToMm * m.maxDisplacement_m;
  r.max_strain = m.maxStrain;
  r.p95_strain = m.p95Strain;
  r.p99_strain = m.p99Strain;
  r.fraction_over_10pct = m.fractionAbove10;
  r.max_rotation_deg = m.maxRotation_deg;
  r.cellsLeftOut = m.cellsLeftOut;
  return m;
}

/// The verdict and its reasons.
void judge(const Model& model, const Body& body, const mechanics::Solution& s, bool loadsBorne, Result& r) {
  constexpr double corotationalStrain = 0.10;
  constexpr double crushedShare = 0.005;  // of the volume; beside a bar single cells always are
  const bool linear = r.kinematics == Kinematics::Linear, converged = s.report.converged();
  mechanics::DeformationSummary judged = measured(model, body, s.u_m, r);
  if (!linear) judged.maxRotation_deg = judged.p95Strain = judged.fractionAbove10 = 0;  // no limits to these
  const mechanics::Validity validity = mechanics::validity(body.mesh(), judged);
  const bool folded = r.contact && !(r.contact->smallestJ > 0);
  const bool said = r.contact && detail::doubtOfBar(*r.contact, model.stiffness, r);
  if (!converged && !loadsBorne && !said)
    detail::tellLoadsNotBorne(model.stiffness, r);
  else if (!converged && !said)
    r.doubt(DiagnosticCode::NotConverged,
            {{"stiffness", model.stiffness},
             {"status", mechanics::describe(s.report.status) +
                            (linear || s.report.why.empty() ? "" : " (" + s.report.why + ")")}});
  r.linearTrusted = validity.linearTrusted && converged;
  r.drawable = converged && !validity.invalid;
  if (r.contact && !linear) {
    // Cut cells that the bar folds say nothing about the body; the mean volume of those that count does.
    r.drawable = converged;
    r.linearTrusted = r.drawable && !folded;
    if (r.drawable && folded) r.doubt(DiagnosticCode::BarFoldsSurface);
  } else {
    // Linear theory has no state with a cell inside out: where the bar makes one, the answer is none.
    if (folded) {
      r.drawable = r.linearTrusted = false;
      if (judged.invertedCells == 0) r.doubt(DiagnosticCode::BarFoldsSurface);
    }
    r.doubts.add(validity.said);
  }
  if (!linear && converged && judged.fractionCrushed > crushedShare)
    r.doubt(DiagnosticCode::CellsCrushed, {{"percent", 100 * judged.fractionCrushed}, {"stiffness", model.stiffness}});
  if (r.kinematics == Kinematics::Corotational && r.p95_strain >= corotationalStrain) {
    r.linearTrusted = false;
    r.doubt(DiagnosticCode::StrainBeyondCorotational,
            {{"percent", 100 * r.p95_strain}, {"limit_percent", 100 * corotationalStrain}});
  }
  r.validity = r.doubts.texts();
}

void noteProbes(const std::vector<Eigen::Vector3d>& probe_u_mm, Diagnostics& said) {
  std::string outside;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < probe_u_mm.size(); ++i) {
    if (probe_u_mm[i].allFinite()) continue;
    outside += (count++ == 0 ? "" : ", ") + std::to_string(i);
  }
  if (count > 0)
    said.add(DiagnosticCode::ProbesOutside,
             {{"count", count}, {"of", static_cast<std::int64_t>(probe_u_mm.size())}, {"probes", outside}});
}

Result readBack(const Model& model, const Body& body, const MechanicsScene& scene, const Setup& setup, Answer answer,
                const std::vector<Eigen::Vector3d>& probes_mm) {
  Result r;
  const mechanics::Solution& s = answer.solution;
  r.solver = s.report;
  r.dofs = answer.dofs;
  r.frames = answer.frames;
  r.steps = answer.steps;
  r.notes = std::move(answer.notes);
  for (std::string& text : s.report.diagnostics.texts(Severity::Warning)) r.notes.push_back(std::move(text));
  r.energy_J = s.energy_J;
  r.load_N = body.vectorToLps(scene.problem.f_N.rowwise().sum()) + answer.following_N;
  r.diagnostics = std::move(answer.diagnostics);
  r.ligaments = std::move(answer.ligaments);
  r.reaction_N = body.vectorToLps(s.reaction_N.rowwise().sum());
  r.u_mm = atCellCentres(body, model.youngs_kPa.grid, s.u_m);

  r.kinematics = setup.kinematics;
  r.contact = std::move(answer.contact);
  if (r.contact) {
    r.load_N += r.contact->force_N;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : r.contact->bar_mm) middle += p / static_cast<double>(r.contact->bar_mm.size());
    r.retractorPoint_mm = middle + r.contact->barRadius_mm * r.contact->hoist;
    r.contactArea_mm2 = r.contact->footprint_mm2;
  }
  judge(model, body, s, answer.loadsBorne, r);
  for (const std::string& limit : answer.limits) r.doubt(DiagnosticCode::MeshfreeLimited, {{"limit", limit}});
  if (answer.useless) r.drawable = r.linearTrusted = false;
  if (scene.contact) {
    r.retractorPoint_mm = scene.contact->centre_mm;
    r.contactArea_mm2 = scene.contact->area_mm2;
    const double cell_mm = mToMm * body.mesh().h_m().maxCoeff();
    if (scene.contact->away_mm > cell_mm)
      r.notes.push_back("the retractor was laid onto the surface: its point lay " +
                        std::to_string(std::lround(scene.contact->away_mm)) + " mm from it");
    for (const SurfaceFace* f : scene.contact->faces)
      r.contactNodes.insert(r.contactNodes.end(), f->nodes.begin(), f->nodes.end());
    std::sort(r.contactNodes.begin(), r.contactNodes.end());
    r.contactNodes.erase(std::unique(r.contactNodes.begin(), r.contactNodes.end()), r.contactNodes.end());
  }
  r.probe_u_mm = interpolate(body, s.u_m, probes_mm);
  noteProbes(r.probe_u_mm, r.diagnostics);
  r.nodal_u_m = std::move(answer.solution.u_m);
  return r;
}

}  // namespace

Result simulate(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& probes_mm,
                const Progress& progress) {
  requireOffered(setup);
  const Body body(model);
  const MechanicsScene scene = toMechanics(body, model, setup);
  if (std::optional<Retractor> bar = rigidBarOf(setup)) {
    Setup used = setup;
    if (used.kinematics == Kinematics::Auto) used.kinematics = Kinematics::Hyperelastic;
    if (!bar->at_mm || !bar->axis) bar = placeBar(model, nullptr, used, progress.part(0.0, 0.3)).bar;
    RigidContactAnswer c = solveRigidContact(body, model, used, scene, *bar, progress);
    Answer answer;
    answer.dofs = c.dofs;
    answer.contact = std::move(c.contact);
    answer.take(std::move(c));
    return readBack(model, body, scene, used, std::move(answer), probes_mm);
  }
  Setup used = setup;
  if (used.kinematics == Kinematics::Auto)
    used.kinematics = inLargeDeformation(setup) ? Kinematics::Hyperelastic : Kinematics::Linear;
  return readBack(model, body, scene, used, solve(model, body, scene, used, progress), probes_mm);
}

Result scaled(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& probes_mm,
              const Result& result, double factor) {
  const Body body(model);
  const MechanicsScene scene = toMechanics(body, model, setup);
  Answer answer;
  answer.solution.u_m = factor * result.nodal_u_m;
  answer.solution.energy_J = factor * result.energy_J;
  answer.solution.report = result.solver;
  answer.solution.report.why = "proportional to the other answer";
  answer.solution.reaction_N = mechanics::NodalField::Zero(3, result.nodal_u_m.cols());
  answer.dofs = result.dofs;
  answer.frames = result.frames;
  Result r = readBack(model, body, scene, setup, std::move(answer), probes_mm);
  r.reaction_N = result.reaction_N;
  return r;
}

std::vector<Eigen::Vector3d> displacementAt(const Model& model, const Result& result,
                                            const std::vector<Eigen::Vector3d>& points_mm) {
  return interpolate(Body(model), result.nodal_u_m, points_mm);
}

}  // namespace glisson::retraction
