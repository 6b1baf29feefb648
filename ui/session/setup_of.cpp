// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/setup_of.h"

#include "session/methods.h"

namespace glisson::session {

namespace {

mechanics::SolverKind kindOf(Solver solver) {
  switch (solver) {
    case Solver::Cg: return mechanics::SolverKind::Cg;
    case Solver::Multigrid: return mechanics::SolverKind::Multigrid;
    case Solver::Factorised: return mechanics::SolverKind::Factorised;
    case Solver::Auto:
    case Solver::Condensed: break;
  }
  return mechanics::SolverKind::Auto;
}

/// All that a rigid bar depends on.
retraction::Setup equationsOf(const Parameters& p) {
  retraction::Setup s;
  s.poisson = p.poisson;
  s.density = Density::fromKgPerM3(p.density_kg_m3);
  s.model = modelOf(p.method);
  s.model.meshfree.frames = p.frames;
  s.model.cell_mm = p.tetEdge_mm;
  s.model.toolCell_mm = p.tetToolEdge_mm;
  s.kinematics = p.kinematics;
  s.analysis.dynamic = p.dynamic;
  s.analysis.h_ms = p.step_ms;
  s.analysis.end_s = p.end_s;
  s.condensed = p.solver == Solver::Condensed;
  s.solver.kind = kindOf(p.solver);
  s.solver.element = s.model.element;
  return s;
}

}  // namespace

std::optional<retraction::RigidRefusal> rigidRefusal(const Parameters& parameters) {
  return retraction::rigidRefusal(equationsOf(parameters));
}

Parameters offered(Parameters p) {
  if (rigidRefusal(p)) p.contact = retraction::ContactKind::Patch;
  if (p.contact == retraction::ContactKind::Rigid) return p;
  p.shape = retraction::BarShape::Straight;
  if (p.drive == Drive::Travel) p.drive = Drive::LiverWeight;
  p.capsule = false;
  return p;
}

retraction::Setup setupOf(const Parameters& parameters) {
  const Parameters p = offered(parameters);
  retraction::Setup s = equationsOf(p);
  if (p.capsule) s.capsule = retraction::Capsule{.tension_N_per_mm = p.capsule_N_per_mm};
  for (const char* surface : {"posterior", "superior"}) {
    retraction::SupportSpec abdomen;
    abdomen.kind = retraction::SupportSpec::Kind::Spring;
    abdomen.region = retraction::SurfaceRegion{surface};
    abdomen.stiffness_kPa_per_mm = p.abdomen_kPa_per_mm;
    s.supports.push_back(abdomen);
  }
  retraction::Retractor retractor;
  retractor.diameter_mm = p.retractorDiameter_mm;
  retractor.length_mm = p.retractorLength_mm;
  retractor.spread_mm = p.retractorSpread_mm;
  retractor.contact = p.contact;
  retractor.shape = p.shape;
  if (p.drive == Drive::Force) retractor.force_N = p.force_N;
  if (p.drive == Drive::Travel) retractor.travel_mm = p.travel_mm;
  s.loads.push_back(retractor);
  session::apply(p.placement, s);
  return s;
}

}  // namespace glisson::session
