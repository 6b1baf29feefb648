// SPDX-License-Identifier: GPL-3.0-or-later

// Beams at every Poisson's ratio, own weight, conjugate gradients stopped at 200.
#include "base/quantity.h"
#include "mechanics/measures.h"
#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "study/beam.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;

Outcome hangingBar(const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({4, 4, 20}, {0.01, 0.01, 0.05}, 12e3, 0.0);
  p.body.density_kg_m3 = 1000.0;
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 5);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -p.body.density_kg_m3 * 9.81});
  mechanics::SolverOptions s;
  s.tolerance = 1e-12;
  const mechanics::Solution r = mechanics::solveStatic(p, s, progress);
  const double exact = -p.body.density_kg_m3 * 9.81 * 0.05 * 0.05 / (2 * 12e3);
  double worst = 0.0;
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const double z = 0.05 - mesh.position_m(n).z();
    worst = std::max(worst, std::abs(r.u_m(2, n) - exact * (2 * z / 0.05 - z * z / (0.05 * 0.05))) / std::abs(exact));
  }
  Outcome o;
  o.add(r.report);
  o.good = worst <= 1e-8 && r.report.converged();
  o.detail = words("end moves ", -1e3 * r.u_m.row(2).minCoeff(), " mm, closed form ", -1e3 * exact,
                   "; largest deviation of any node ", worst);
  return o;
}

Outcome ownWeight(const Progress& progress) {
  // An ellipsoid of 1.5 L on its lowest tenth, 6 kPa.
  const Vector3d half(0.1, 0.065, 0.055);
  mechanics::Problem p;
  p.body = solidBox({20, 13, 11}, 2 * half, 6e3, 0.45);
  paint(p.body, [&](const Vector3d& c) { return (c - half).cwiseQuotient(half).norm() <= 1 ? 6e3 : 0.0; });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = mechanics::fix(nodesWhere(mesh, [&](const Vector3d& x) { return x.x() <= 0.021; }));
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -p.body.density_kg_m3 * 9.81});
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  const mechanics::DeformationSummary m = mechanics::summarise(mesh, r.u_m);
  const mechanics::Validity v = mechanics::validity(mesh, m);
  Outcome o;
  o.add(r.report);
  o.good = m.p95Strain > 0.1 && !v.linearTrusted && !v.warnings.empty();
  o.detail = words("95 % strain below ", m.p95Strain, ", rotation ", m.maxRotation_deg,
                   " deg: ", v.warnings.empty() ? "no warning" : v.warnings.front());
  return o;
}

Outcome lockingFree(double poisson, const Progress& progress) {
  BeamOptions b;
  b.poisson = poisson;
  Outcome o;
  double tip[2];
  const Eigen::Vector3i grids[2] = {{30, 6, 6}, {60, 12, 12}};
  for (int i = 0; i < 2; ++i) {
    const mechanics::Problem p = beamProblem(b, grids[i], Root::Clamped);
    const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
    tip[i] = axisDeflection_mm(mechanics::VoxelMesh(p.body), r.u_m).back();
    o.add(r.report);
    if (!r.report.converged()) o.detail = "not converged; ";
  }
  const double off = std::abs(tip[0] / tip[1] - 1);
  // Every theory has the tip within 5 % of 1 mm: a tenth off would be locking on both grids.
  o.good = o.detail.empty() && off <= 0.05 && tip[1] > 0.9 && tip[1] < 1.1;
  o.detail += words("tip ", tip[0], " mm at 1.67 mm cells, ", tip[1], " at 0.83 mm: ", 100 * off, " % apart");
  return o;
}

Outcome stoppedAt200(double poisson, const Progress& progress) {
  BeamOptions b;
  b.poisson = poisson;
  const mechanics::Problem p = beamProblem(b, {30, 6, 6}, Root::Clamped);
  mechanics::SolverOptions s;
  s.kind = mechanics::SolverKind::Cg;
  s.preconditioner = mechanics::Preconditioner::None;
  s.iterations = 200;
  s.element = mechanics::HexElement::H8;
  mechanics::StaticSolver solver(p.body, p.supports, s, progress);
  const mechanics::Solution r = solver.solve(p.f_N, progress);
  // The residual again, by hand.
  mechanics::NodalField f = p.f_N;
  solver.voxels().project(f);
  const double own = (f - solver.voxels().apply(r.u_m)).norm() / f.norm();
  Outcome o;
  o.add(r.report);
  const bool honest = std::abs(own - r.report.residual) <= 1e-6 * own + 1e-12;
  o.good = honest && r.report.converged() == (own <= s.tolerance) && (poisson < 0.44 || !r.report.converged());
  o.detail =
      words(mechanics::describe(r.report.status), ", reported residual ", r.report.residual, ", recomputed ", own);
  return o;
}

Outcome thickSlices(const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({6, 5, 4}, {6 * 1.64e-3, 5 * 1.64e-3, 0.04}, 6e3, 0.45);
  const mechanics::VoxelMesh mesh(p.body);
  Eigen::Matrix3d G;
  G << 1e-3, 2e-3, -1e-3, 0.5e-3, -2e-3, 3e-3, 1e-3, 1.5e-3, 2e-3;
  const Vector3d size = mesh.cells().cast<double>().cwiseProduct(mesh.h_m());
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const Vector3d x = mesh.position_m(n);
    if ((x.array() > 1e-9).all() && (x.array() < size.array() - 1e-9).all()) continue;
    p.supports.fixations.push_back({n, {true, true, true}, G * x});
  }
  p.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  mechanics::SolverOptions s;
  s.tolerance = 1e-12;
  const mechanics::Solution r = mechanics::solveStatic(p, s, progress);
  mechanics::NodalField exact(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) exact.col(n) = G * mesh.position_m(n);
  const double off = relativeDifference(r.u_m, exact);
  Outcome o;
  o.add(r.report);
  o.good = off <= 1e-10;
  o.detail = words("a linear field comes back to ", off);
  return o;
}

Outcome tooManyFrames(const Progress& progress) {
  const mechanics::Problem p = beamProblem({}, {10, 2, 2}, Root::Clamped);
  mechanics::MeshfreeOptions mo;
  mo.frames = 500;
  mo.order = 2;
  const mechanics::MeshfreeModel model(p, mo, mechanics::HexElement::Incompatible, progress);
  const mechanics::Solution r = model.solveStatic({}, progress);
  Outcome o;
  o.add(r.report);
  o.good = model.frames() < 500 && !model.notes().empty() && r.report.converged() && r.u_m.allFinite();
  o.detail = words(model.frames(), " frames placed; ", model.notes().empty() ? "no note" : model.notes().front());
  return o;
}

}  // namespace

Scenes bendingScenes(const StabilityOptions&) {
  Scenes s;
  s.push_back({"hanging bar, Poisson 0", "u = rho g L2 / 2E = 1.0219 mm (rho 1000 kg/m3)", hangingBar});
  s.push_back({"liver held at one end, own weight", "strain beyond 0.1: marked as outside linear theory", ownWeight});
  for (const double nu : {0.0, 0.3, 0.45, 0.49, 0.499, 0.4999})
    s.push_back({words("beam, Poisson ", nu), "free of locking: within 5 % at 1.67 mm cells, converged",
                 [nu](const Progress& p) { return lockingFree(nu, p); }});
  for (const double nu : {0.3, 0.45, 0.49})
    s.push_back({words("conjugate gradients stopped at 200, Poisson ", nu),
                 "true residual reported; called unconverged from Poisson 0.45 on",
                 [nu](const Progress& p) { return stoppedAt200(nu, p); }});
  s.push_back({"voxels 1.64 x 1.64 x 10 mm", "a linear field is exact", thickSlices});
  s.push_back({"more frames than the voxels can tell apart", "fewer are placed, with a note", tooManyFrames});
  return s;
}

}  // namespace glisson::study
