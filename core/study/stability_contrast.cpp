// SPDX-License-Identifier: GPL-3.0-or-later

// Stiff and soft together: inclusions, random moduli, bars in series and side by side, spheres with closed forms.
#include <limits>
#include <numbers>

#include "base/random.h"
#include "mechanics/measures.h"
#include "mechanics/static_solve.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;

/// A block with these moduli, clamped below and sheared on top: default solver against the factorisation.
Outcome againstFactorised(const std::function<double(const Vector3d&)>& E_Pa, int n, const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({n, n, n}, Vector3d::Constant(0.06), 6e3, 0.45);
  paint(p.body, E_Pa);
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 4);
  p.f_N = mechanics::tractionForce(mesh, facesOn(mesh, 5), Vector3d(20, 0, -50));
  mechanics::SolverOptions standard, factorised;
  standard.tolerance = factorised.tolerance = 1e-11;
  factorised.kind = mechanics::SolverKind::Factorised;
  const mechanics::Solution a = mechanics::solveStatic(p, standard, progress);
  const mechanics::Solution b = mechanics::solveStatic(p, factorised, progress);
  const double off = relativeDifference(a.u_m, b.u_m);
  const double balance = (a.reaction_N.rowwise().sum() + p.f_N.rowwise().sum()).norm() / p.f_N.rowwise().sum().norm();
  Outcome o;
  o.add(a.report);
  o.good = off <= 1e-8 && a.u_m.allFinite() && a.report.converged();
  o.detail = words(a.report.kind, " against factorised: displacement ", off, " apart, balance ", balance);
  return o;
}

Outcome seriesBar(double contrast, const Progress& progress) {
  const double L = 0.05, E = 12e3, F = 1e-3, A = 1e-4;
  mechanics::Problem p;
  p.body = solidBox({20, 4, 4}, {L, 0.01, 0.01}, E, 0.0);
  paint(p.body, [&](const Vector3d& c) { return c.x() < L / 2 ? E : E * contrast; });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 0);
  p.f_N = mechanics::tractionForce(mesh, facesOn(mesh, 1), Vector3d(F / A, 0, 0));
  mechanics::SolverOptions s;
  s.tolerance = 1e-13;
  const mechanics::Solution r = mechanics::solveStatic(p, s, progress);
  const double exact = F / A * (L / 2) * (1 / E + 1 / (E * contrast));
  double worst = 0.0;
  for (const int n : mechanics::nodesOfFaces(mesh, facesOn(mesh, 1)))
    worst = std::max(worst, std::abs(r.u_m(0, n) - exact) / exact);
  Outcome o;
  o.add(r.report);
  o.good = worst <= 1e-10;
  o.detail = words("stretch ", 1e6 * exact, " um by closed form, every end node within ", worst);
  return o;
}

Outcome parallelBar(double contrast, const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({10, 6, 4}, {0.05, 0.01, 0.01}, 12e3, 0.0);
  paint(p.body, [&](const Vector3d& c) { return c.y() < 0.005 ? 12e3 : 12e3 * contrast; });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 0);
  const double stretch = 1e-4;
  std::vector<int> end = mechanics::nodesOfFaces(mesh, facesOn(mesh, 1));
  for (const int n : end) p.supports.fixations.push_back({n, {true, false, false}, {stretch, 0, 0}});
  p.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  mechanics::SolverOptions s;
  s.tolerance = 1e-13;
  const mechanics::Solution r = mechanics::solveStatic(p, s, progress);
  double force = 0.0;
  for (const int n : end) force += r.reaction_N(0, n);
  const double exact = 12e3 * (1 + contrast) / 2 * 1e-4 * stretch / 0.05;
  Outcome o;
  o.add(r.report);
  o.good = std::abs(force / exact - 1) <= 1e-10;
  o.detail = words("force over arithmetic mean of E: off by ", force / exact - 1);
  return o;
}

/// An eighth of a ball or hollow ball: mirror planes at x, y, z = 0.
std::vector<mechanics::Fixation> mirrors(const mechanics::VoxelMesh& mesh) {
  std::vector<mechanics::Fixation> all;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<bool, 3> held = {false, false, false};
    held[static_cast<std::size_t>(axis)] = true;
    for (const int n : nodesWhere(mesh, [&](const Vector3d& x) { return x[axis] == 0.0; }))
      all.push_back({n, held, Vector3d::Zero()});
  }
  return all;
}

constexpr double sphereInner_m = 0.02, sphereOuter_m = 0.05, spherePressure_Pa = 100;

/// Mean radial displacement (m) of a thick sphere, E 3 kPa, at its inner and outer radius; n voxels over 50 mm.
Eigen::Vector2d thickSphere_m(int n, Outcome& o, const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({n, n, n}, Vector3d::Constant(sphereOuter_m), 3e3, 0.45);
  paint(p.body, [](const Vector3d& c) { return c.norm() >= sphereInner_m && c.norm() <= sphereOuter_m ? 3e3 : 0.0; });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = mirrors(mesh);
  std::vector<mechanics::Face> inner;
  for (const mechanics::Face& f : mechanics::exteriorFaces(mesh))
    if (f.side % 2 == 0 && mesh.cellOf(f.filledCell)[f.side / 2] > 0) inner.push_back(f);
  p.f_N = mechanics::pressureForce(mesh, inner, spherePressure_Pa);
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  o.add(r.report);
  o.good = o.good && r.report.converged();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  constexpr int directions = 20;  // equal areas: uniform in cos θ and φ
  for (int i = 0; i < directions; ++i)
    for (int j = 0; j < directions; ++j) {
      const double z = (i + 0.5) / directions, phi = (j + 0.5) / directions * std::numbers::pi / 2;
      const double xy = std::sqrt(1 - z * z);
      const Vector3d d(xy * std::cos(phi), xy * std::sin(phi), z);
      for (int at = 0; at < 2; ++at) {
        const auto u = mechanics::displacementAt(mesh, r.u_m, (at == 0 ? sphereInner_m : sphereOuter_m) * d);
        mean[at] += u ? u->dot(d) / (directions * directions) : std::numeric_limits<double>::quiet_NaN();
      }
    }
  return mean;
}

Outcome thickSphere(int n, const Progress& progress) {
  Outcome o;
  o.good = true;
  // A staircase converges with first order: two voxel sizes together take most of its error away.
  const Eigen::Vector2d coarse = thickSphere_m(n, o, progress), fine = thickSphere_m(2 * n, o, progress);
  const Eigen::Vector2d both = 2 * fine - coarse;
  const double a3 = std::pow(sphereInner_m, 3), b3 = std::pow(sphereOuter_m, 3), nu = 0.45;
  const auto exact = [&](double s) {
    return spherePressure_Pa * a3 / (3e3 * (b3 - a3)) * ((1 - 2 * nu) * s + (1 + nu) * b3 / (2 * s * s));
  };
  const Eigen::Vector2d known(exact(sphereInner_m), exact(sphereOuter_m));
  const double off = (both - known).cwiseQuotient(known).cwiseAbs().maxCoeff();
  o.good = o.good && off <= 0.01;
  o.detail = words("u(a), u(b) ", 1e3 * both[0], ", ", 1e3 * both[1], " mm; closed form ", 1e3 * known[0], ", ",
                   1e3 * known[1], "; voxels of ", 50.0 / n, " mm alone ", 1e3 * coarse[0], ", ", 1e3 * coarse[1],
                   ", of ", 25.0 / n, " mm ", 1e3 * fine[0], ", ", 1e3 * fine[1]);
  return o;
}

/// Strain in a spherical inclusion over the strain far away, hydrostatic: (3K + 4µ) / (3K' + 4µ).
Outcome eshelby(double contrast, int n, const Progress& progress) {
  const double nu = 0.45, E = 3e3, a = 0.01, side = 0.04, far = 1e-3;
  const auto bulk = [&](double e) { return e / (3 * (1 - 2 * nu)); };
  const double mu = E / (2 * (1 + nu));
  const double ratio = (3 * bulk(E) + 4 * mu) / (3 * bulk(E * contrast) + 4 * mu);
  mechanics::Problem p;
  p.body = solidBox({n, n, n}, Vector3d::Constant(side), E, nu);
  paint(p.body, [&](const Vector3d& c) { return c.norm() <= a ? E * contrast : E; });
  const mechanics::VoxelMesh mesh(p.body);
  p.supports.fixations = mirrors(mesh);
  // Beyond the sphere u = x (ε + (ε_in − ε) a³/r³): held so on the outer faces, the body stands for an endless one.
  for (const int k : nodesWhere(mesh, [&](const Vector3d& x) { return x.maxCoeff() > side * (1 - 1e-9); })) {
    const Vector3d x = mesh.position_m(k);
    const double r3 = std::pow(x.norm(), 3);
    p.supports.fixations.push_back({k, {true, true, true}, far * x * (1 + (ratio - 1) * a * a * a / r3)});
  }
  p.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  const mechanics::CellMeasures m = mechanics::measureCells(mesh, r.u_m);
  double mean = 0.0;
  int cells = 0;
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const Vector3d c = (mesh.cellOf(e).cast<double>() + Vector3d::Constant(0.5)).cwiseProduct(mesh.h_m());
    if (c.norm() > a) continue;
    mean += m.strain.col(e).head<3>().mean();
    ++cells;
  }
  const double found = mean / cells / far;
  Outcome o;
  o.add(r.report);
  o.good = std::abs(found / ratio - 1) <= 0.05 && r.report.converged();
  o.detail = words("strain ratio ", found, ", closed form ", ratio, " (", 100 * (found / ratio - 1), " % off) with ",
                   cells, " voxels in an eighth of the sphere");
  return o;
}

}  // namespace

Scenes contrastScenes(const StabilityOptions& options) {
  Scenes s;
  const int n = options.quick ? 10 : 20;
  for (const double c : {10.0, 1e2, 1e4, 1e6})
    s.push_back({words("stiff inclusion x", c), "default solver = factorised to 1e-8", [c, n](const Progress& p) {
                   return againstFactorised(
                       [c](const Vector3d& x) { return (x - Vector3d::Constant(0.03)).norm() < 0.012 ? 6e3 * c : 6e3; },
                       n, p);
                 }});
  for (const int decades : {2, 4, 6})
    s.push_back({words("random moduli over ", decades, " decades"), "default solver = factorised to 1e-8",
                 [decades, n](const Progress& p) {
                   Random random(7);
                   return againstFactorised(
                       [&](const Vector3d&) { return 6e3 * std::pow(10.0, decades * random.uniform(-0.5, 0.5)); }, n,
                       p);
                 }});
  for (const double c : {1.0, 1e2, 1e4, 1e6}) {
    s.push_back({words("bar in series, contrast ", c), "stretch by closed form to 1e-10",
                 [c](const Progress& p) { return seriesBar(c, p); }});
    s.push_back({words("bars side by side, contrast ", c), "arithmetic mean of E to 1e-10",
                 [c](const Progress& p) { return parallelBar(c, p); }});
  }
  const int coarse = options.quick ? 20 : 40;
  s.push_back({"thick sphere under pressure", "u(a) 0.52094, u(b) 0.09402 mm within 1 %, two voxel sizes extrapolated",
               [coarse](const Progress& p) { return thickSphere(coarse, p); }});
  for (const double c : {0.1, 10.0, 1000.0})
    s.push_back({words("spherical inclusion, hydrostatic, contrast ", c), "Eshelby's strain ratio within 5 % on voxels",
                 [c, q = options.quick](const Progress& p) { return eshelby(c, q ? 40 : 48, p); }});
  return s;
}

}  // namespace glisson::study
