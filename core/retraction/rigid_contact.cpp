// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/rigid_contact.h"

#include <algorithm>

#include "base/error.h"
#include "retraction/contact_path.h"
#include "retraction/detail/contact_scene.h"
#include "retraction/ligaments.h"

namespace glisson::retraction {
namespace {

constexpr double loosestTolerance = 1e-3;
constexpr double nothing = 1e-6;  ///< of the force asked for

/// What is offered in place of what refuses.
const char* offeredFor(RigidRefusal refusal) {
  switch (refusal) {
    case RigidRefusal::Model: return "the model \"fem-hex\"";
    case RigidRefusal::TimeSteps: return "the static analysis";
    case RigidRefusal::Condensed: return "solvers other than \"condensed\"";
    case RigidRefusal::Corotational: break;
  }
  return "kinematics \"hyperelastic\", \"linear\" or \"auto\"";
}

}  // namespace

std::optional<RigidRefusal> rigidRefusal(const Setup& setup) {
  if (setup.model.kind != ModelKind::FemHex) return RigidRefusal::Model;
  if (setup.analysis.dynamic) return RigidRefusal::TimeSteps;
  if (setup.condensed) return RigidRefusal::Condensed;
  if (setup.kinematics == Kinematics::Corotational) return RigidRefusal::Corotational;
  return {};
}

std::optional<Retractor> rigidBarOf(const Setup& setup) {
  const std::optional<RigidRefusal> refusal = rigidRefusal(setup);
  for (const LoadSpec& load : setup.loads) {
    const auto* r = std::get_if<Retractor>(&load);
    if (r == nullptr || r->contact == ContactKind::Patch) continue;
    if (!refusal) return *r;
    if (r->contact == ContactKind::Rigid || r->travel_mm || r->shape == BarShape::Hook)
      throw BadInput(std::string("a rigid retractor is offered for ") + offeredFor(*refusal) +
                     " only: change that, or ask for \"contact\": \"patch\" with a force");
  }
  return {};
}

bool wantsRigidBar(const Setup& setup) {
  try {
    return rigidBarOf(setup).has_value();
  } catch (const BadInput&) {
    return true;
  }
}

bool isOneSided(const SupportSpec& s) {
  return s.kind == SupportSpec::Kind::Ligament || (s.kind == SupportSpec::Kind::Spring && s.unilateral);
}

bool inLargeDeformation(const Setup& setup) {
  return setup.kinematics == Kinematics::Hyperelastic || rigidBarOf(setup).has_value() ||
         (setup.kinematics == Kinematics::Auto && !rigidRefusal(setup) &&
          std::any_of(setup.supports.begin(), setup.supports.end(), isOneSided));
}

LargeDeformationAnswer solveWithoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene,
                                       double tolerance, const Progress& progress) {
  mechanics::ContactOptions options;
  options.tolerance = tolerance;
  mechanics::ContactSolution s = mechanics::solveContact(withoutBar(body, setup, scene), options, progress);
  LargeDeformationAnswer answer;
  answer.following_N = body.vectorToLps(s.following_N);
  const std::vector<LigamentFibres> ligaments = ligamentsOf(body, setup);
  answer.ligaments = pullsOf(body, ligaments, s.tether_N);
  answer.diagnostics = estimatesOf(ligaments);
  answer.loadsBorne = s.outcome != mechanics::ContactOutcome::LoadsNotBorne;
  answer.solution = std::move(s.solution);
  return answer;
}

mechanics::NodalField onModelNodes(const Body& body, const ContactScene& scene, const mechanics::NodalField& u_m) {
  const mechanics::VoxelMesh mesh(scene.problem.problem.body);
  const int count = body.mesh().nodeCount();
  mechanics::NodalField u = mechanics::NodalField::Zero(3, count);
  for (int node = 0; node < count; ++node)
    if (const int best = detail::nodeNear(mesh, body.mesh().latticeOf(node) + scene.layers); best >= 0)
      u.col(node) = u_m.col(best);
  return u;
}

namespace {

RigidContact toRetraction(const Body& body, const ContactScene& scene, const mechanics::ContactSolution& s) {
  const auto vector = [&](const Eigen::Vector3d& v) { return body.vectorToLps(v); };
  const Eigen::Vector3d shift_m = scene.layers.cast<double>().cwiseProduct(body.voxels().h_m);
  RigidContact c;
  c.travel_mm = 1e3 * s.travel_m;
  c.capacity_N = s.capacity_N;
  c.capacityAt_mm = 1e3 * s.capacity_m;
  c.capacityExceeded = s.capacityExceeded;
  c.outcome = s.outcome;
  c.asked_N = scene.problem.force_N.value_or(0.0);
  c.asked_mm = 1e3 * scene.problem.travel_m.value_or(0.0);
  c.force_N = vector(s.force_N);
  c.moment_Nm = vector(s.moment_Nm);
  c.area_mm2 = 1e6 * s.area_m2;
  c.footprint_mm2 = 1e6 * s.footprint_m2;
  c.pressureMax_kPa = 1e-3 * s.pressureMax_Pa;
  c.penetrationMax_mm = 1e3 * s.penetrationMax_m;
  c.smallestJ = s.smallestJ;
  for (const Eigen::Vector3d& p : s.bar.centreline_m) c.bar_mm.push_back(body.toLps_mm(p - shift_m));
  c.barRadius_mm = 1e3 * s.bar.radius_m;
  c.moved_mm = 1e3 * (s.bar.centre_m() - scene.problem.bar->centre_m()).dot(s.bar.hoist) - barBehind_mm +
               c.barRadius_mm + 1e3 * s.touch_m;
  c.hoist = vector(s.bar.hoist);
  for (const mechanics::PathStep& step : s.path) c.path.push_back({1e3 * step.travel_m, step.force_N});
  if (const std::optional<std::array<double, 2>> most = passedOnTheWay(c)) {
    c.capacityExceeded = true;
    c.capacityAt_mm = (*most)[0];
    c.capacity_N = (*most)[1];
  }
  c.sample_mm = scene.sample_mm;
  c.cut_u_m = s.solution.u_m;
  for (std::size_t i = 0; i < scene.problem.surface.size(); ++i) {
    c.sample_u_mm.push_back(1e3 * vector(s.surface_u_m.col(static_cast<Eigen::Index>(i))));
    c.sample_mm2.push_back(1e6 * scene.problem.surface[i].area_m2);
    c.pressure_kPa.push_back(1e-3 * s.pressure_Pa[i]);
  }
  return c;
}

/// The answer on the nodes of the model's own cells.
void toModelNodes(const Body& body, const ContactScene& scene, mechanics::Solution& s) {
  const mechanics::VoxelMesh mesh(scene.problem.problem.body);
  mechanics::NodalField u = onModelNodes(body, scene, s.u_m);
  mechanics::NodalField reaction = mechanics::NodalField::Zero(3, body.mesh().nodeCount());
  // Reactions keep their sum: what acts on nodes of cut cells only is added to the first node of the model.
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i at = mesh.latticeOf(node) - scene.layers;
    const bool inside = (at.array() >= 0).all() && (at.array() <= body.mesh().cells().array()).all();
    const int own = inside ? body.mesh().nodeAt(at.x(), at.y(), at.z()) : -1;
    reaction.col(std::max(own, 0)) += s.reaction_N.col(node);
  }
  s.u_m = std::move(u);
  s.reaction_N = std::move(reaction);
}

}  // namespace

RigidContactAnswer solveRigidContact(const Body& body, const Model& model, const Setup& setup,
                                     const MechanicsScene& scene, const Retractor& bar, const Progress& progress) {
  const ContactScene contact = contactScene(body, model, setup, scene, bar);
  mechanics::ContactOptions options;
  options.tolerance = std::clamp(setup.solver.tolerance, 1e-6, loosestTolerance);
  mechanics::ContactSolution s = mechanics::solveContact(contact.problem, options, progress);
  // Ligaments that go slack as the body moves resist at the start only.
  if (s.outcome == mechanics::ContactOutcome::Slips && contact.problem.force_N &&
      s.capacity_N < nothing * *contact.problem.force_N)
    throw BadInput(
        "nothing resists the bar: along its hoist the body moves freely, as ligaments are slack or nothing holds it; "
        "add "
        "supports that pull as well, or hoist the other way");
  RigidContactAnswer answer;
  answer.dofs = static_cast<int>(3 * s.solution.u_m.cols());
  answer.contact = toRetraction(body, contact, s);
  answer.following_N = body.vectorToLps(s.following_N);
  const std::vector<LigamentFibres> ligaments = ligamentsOf(body, setup);
  answer.ligaments = pullsOf(body, ligaments, s.tether_N);
  answer.diagnostics = estimatesOf(ligaments);
  answer.solution = std::move(s.solution);
  toModelNodes(body, contact, answer.solution);
  return answer;
}

}  // namespace glisson::retraction
