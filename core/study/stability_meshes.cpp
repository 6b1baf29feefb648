// SPDX-License-Identifier: GPL-3.0-or-later

// Tetrahedra and mesh-free sites: a known stress, flat and inverted elements, sites that cannot carry a model.
#include <Eigen/QR>
#include <numbers>

#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "mechanics/tet_element.h"
#include "mechanics/tet_solve.h"
#include "study/beam.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;

// NAFEMS LE10, thick elliptic plate: a quarter between the ellipses (2, 1) and (3.25, 2.75) m, 0.6 m thick, E 210 GPa,
// Poisson's ratio 0.3, 1 MPa on the upper surface. y = 0 held along y, x = 0 along x, the outer wall along x and y, its
// middle line along z. σyy at D = (2, 0, 0.6) is −5.38 MPa.
constexpr double le10_MPa = -5.38;

Vector3d onPlate(const Vector3d& unit) {
  const double r = unit.x();
  const double angle = unit.y() * std::numbers::pi / 2;
  return {(2 + 1.25 * r) * std::cos(angle), (1 + 1.75 * r) * std::sin(angle), 0.6 * unit.z()};
}

mechanics::TetProblem plate(const Eigen::Vector3i& cells, bool quadratic) {
  const mechanics::VoxelBody body = solidBox(cells, {1, 1, 1}, 210e9, 0.3);
  mechanics::TetProblem p;
  p.mesh = mechanics::tetrahedra(body, mechanics::VoxelMesh(body));
  if (quadratic) p.mesh = mechanics::withMiddles(p.mesh);
  p.poisson = 0.3;
  const Eigen::Matrix3Xd unit = p.mesh.nodes_m;
  for (int node = 0; node < p.mesh.nodeCount(); ++node) {
    const Vector3d x = unit.col(node);
    const bool outer = x.x() > 1 - 1e-9;
    const mechanics::Fixation f{
        node,
        {outer || x.y() > 1 - 1e-9, outer || x.y() < 1e-9, outer && std::abs(x.z() - 0.5) < 1e-9},
        Vector3d::Zero()};
    if (f.axis[0] || f.axis[1] || f.axis[2]) p.supports.fixations.push_back(f);
    p.mesh.nodes_m.col(node) = onPlate(x);
  }
  std::vector<mechanics::TetFace> top;
  for (const mechanics::TetFace& face : mechanics::exteriorFaces(p.mesh)) {
    bool all = true;
    for (const int node : mechanics::nodesOf(p.mesh, face)) all = all && unit(2, node) > 1 - 1e-9;
    if (all) top.push_back(face);
  }
  p.f_N = mechanics::tractionForce(p.mesh, top, {0, 0, -1e6});
  return p;
}

/// σyy (MPa) at a corner node, mean over the tetrahedra that meet there: what quadratic ones give.
double meanStress_MPa(const mechanics::TetProblem& p, const mechanics::NodalField& u_m, const Vector3d& at_m) {
  const std::array<Vector3d, 4> corner = {Vector3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double sum = 0;
  int count = 0;
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    for (int a = 0; a < 4; ++a)
      if ((p.mesh.nodes_m.col(p.mesh.tets(a, t)) - at_m).norm() < 1e-9) {
        sum += mechanics::tetStress_Pa(p.mesh, t, p.poisson, u_m, corner[static_cast<std::size_t>(a)])[1];
        ++count;
      }
  return 1e-6 * sum / count;
}

/// σyy (MPa) recovered at a point from constant stresses: a full quadratic polynomial, least squares over the centroids
/// of the tetrahedra within `reach_m` [zienkiewicz1992superconvergent].
double recoveredStress_MPa(const mechanics::TetProblem& p, const mechanics::NodalField& u_m, const Vector3d& at_m,
                           double reach_m) {
  std::vector<std::pair<Vector3d, double>> samples;
  for (int t = 0; t < p.mesh.tetCount(); ++t) {
    Vector3d c = Vector3d::Zero();
    for (int a = 0; a < 4; ++a) c += 0.25 * p.mesh.nodes_m.col(p.mesh.tets(a, t));
    if ((c - at_m).norm() > reach_m) continue;
    samples.emplace_back((c - at_m) / reach_m,
                         mechanics::tetStress_Pa(p.mesh, t, p.poisson, u_m, Vector3d::Constant(0.25))[1]);
  }
  Eigen::MatrixXd P(static_cast<Eigen::Index>(samples.size()), 10);
  Eigen::VectorXd s(P.rows());
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    const auto& [x, value] = samples[static_cast<std::size_t>(i)];
    P.row(i) << 1, x.x(), x.y(), x.z(), x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), x.x() * x.y(), x.y() * x.z(),
        x.z() * x.x();
    s[i] = value;
  }
  return 1e-6 * P.colPivHouseholderQr().solve(s)[0];
}

Outcome le10(const Eigen::Vector3i& cells, bool quadratic, const Progress& progress) {
  const mechanics::TetProblem p = plate(cells, quadratic);
  const mechanics::Solution r = mechanics::solveTets(p, {}, progress);
  const Vector3d D(2, 0, 0.6);
  const double stress = quadratic ? meanStress_MPa(p, r.u_m, D) : recoveredStress_MPa(p, r.u_m, D, 0.5);
  const double off = stress / le10_MPa - 1;
  Outcome o;
  o.add(r.report);
  o.good = r.report.converged() && std::abs(off) <= (quadratic ? 0.02 : 0.06);
  o.detail = words("syy(D) ", stress, " MPa with ", p.mesh.tetCount(), quadratic ? " T10" : " T4, recovered", ": ",
                   100 * off, " % off");
  return o;
}

/// A cube of 30 mm of 3 × 3 × 3 cells, held on x = 0 and pulled at the other end. Along the axes asked for, the two
/// inner planes of nodes are moved to `squeeze` and twice that times their place: one axis gives sheets, two give
/// needles.
mechanics::TetProblem block(double squeeze, const std::array<bool, 3>& axes) {
  constexpr double L = 0.03;
  const mechanics::VoxelBody body = solidBox({3, 3, 3}, {L, L, L}, 6e3, 0.0);
  mechanics::TetProblem p;
  p.mesh = mechanics::tetrahedra(body, mechanics::VoxelMesh(body));
  p.poisson = 0.0;
  for (int n = 0; n < p.mesh.nodeCount(); ++n)
    for (int a = 0; a < 3; ++a) {
      double& x = p.mesh.nodes_m(a, n);
      if (axes[static_cast<std::size_t>(a)] && x < 0.9 * L) x *= squeeze;
    }
  for (int n = 0; n < p.mesh.nodeCount(); ++n)
    if (p.mesh.nodes_m(0, n) == 0.0) p.supports.fixations.push_back({n, {true, true, true}, Vector3d::Zero()});
  std::vector<mechanics::TetFace> end;
  for (const mechanics::TetFace& f : mechanics::exteriorFaces(p.mesh)) {
    bool all = true;
    for (const int n : mechanics::nodesOf(p.mesh, f)) all = all && p.mesh.nodes_m(0, n) > 0.9 * L;
    if (all) end.push_back(f);
  }
  p.f_N = mechanics::tractionForce(p.mesh, end, {60, 0, 0});
  return p;
}

/// A middle node pushed along x until its tetrahedra are flat (1) or inside out (beyond).
Outcome badTets(double push, const Progress& progress) {
  return refused(
      [&] {
        mechanics::TetProblem p = block(1.0, {});
        for (int n = 0; n < p.mesh.nodeCount(); ++n)
          if ((p.mesh.nodes_m.col(n) - Vector3d(0.01, 0.01, 0.01)).norm() < 1e-9) p.mesh.nodes_m(0, n) += 0.01 * push;
        mechanics::solveTets(p, {}, progress);
      },
      {"tetrahedron"});
}

/// Sheets and needles in a cube that stretches by σ L / E whatever its mesh.
Outcome aspect(double squeeze, const std::array<bool, 3>& axes, const Progress& progress) {
  const mechanics::TetProblem p = block(squeeze, axes);
  const mechanics::Solution r = mechanics::solveTets(p, {}, progress);
  const double exact = 60.0 / 6e3 * 0.03, found = r.u_m.row(0).maxCoeff();
  Outcome o;
  o.add(r.report);
  o.good = r.report.converged() && r.u_m.allFinite() && std::abs(found / exact - 1) <= 1e-6;
  o.detail = words("aspect ", 1 / squeeze, ": stretch off sigma L / E by ", found / exact - 1, ", ",
                   mechanics::describe(r.report.status));
  return o;
}

/// Sites given by hand on a beam. The energy of any mesh-free model lies below that of its voxels.
Outcome sites(const mechanics::MeshfreeOptions& options, const std::string& noteSays, const Progress& progress) {
  const mechanics::Problem p = beamProblem({}, {20, 4, 4}, Root::Clamped);
  const mechanics::MeshfreeModel model(p, options, mechanics::HexElement::Incompatible, progress);
  const mechanics::Solution r = model.solveStatic({}, progress);
  const double full_J = mechanics::solveStatic(p, {}, progress).energy_J;
  std::string notes;
  for (const std::string& n : model.notes()) notes += (notes.empty() ? "" : "; ") + n;
  Outcome o;
  o.add(r.report);
  o.good = r.report.converged() && r.u_m.allFinite() && r.energy_J > 0 && r.energy_J <= full_J * (1 + 1e-7) &&
           notes.find(noteSays) != std::string::npos;
  o.detail = words(model.frames(), " frames, energy ", r.energy_J / full_J, " of the voxels', ",
                   mechanics::describe(r.report.status), "; note: ", notes.empty() ? "none" : notes);
  return o;
}

mechanics::MeshfreeOptions placed(mechanics::Kernel kernel, int order, const Eigen::Matrix3Xd& sites_m) {
  mechanics::MeshfreeOptions o;
  o.kernel = kernel;
  o.order = order;
  o.frames = static_cast<int>(sites_m.cols());
  o.sites_m = sites_m;
  return o;
}

/// n × 2 × layers sites on a lattice inside the beam of 50 × 10 × 10 mm.
Eigen::Matrix3Xd lattice(int n, int layers) {
  Eigen::Matrix3Xd at(3, 2 * n * layers);
  int next = 0;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < n; ++i)
        at.col(next++) = Vector3d(0.05 * (i + 0.5) / n, 0.005 * (j + 0.5), 0.01 * (k + 0.5) / layers);
  return at;
}

}  // namespace

Scenes meshScenes(const StabilityOptions& options) {
  using mechanics::Kernel;
  Scenes s;
  const bool q = options.quick;
  s.push_back({"NAFEMS LE10, quadratic tetrahedra", "syy(D) = -5.38 MPa within 2 %",
               [q](const Progress& p) { return le10(Eigen::Vector3i(10, 14, 4), true, p); }});
  s.push_back({"NAFEMS LE10, linear tetrahedra, recovered", "syy(D) = -5.38 MPa within 6 %", [q](const Progress& p) {
                 return le10(q ? Eigen::Vector3i(16, 24, 8) : Eigen::Vector3i(20, 28, 10), false, p);
               }});
  for (const auto& [name, push] :
       {std::pair<const char*, double>{"flat tetrahedra", 1.0}, {"inverted tetrahedra", 1.5}})
    s.push_back(
        {name, "refused, naming the tetrahedron", [push = push](const Progress& p) { return badTets(push, p); }});
  s.push_back({"tetrahedra of aspect 1e4, sheets", "stretch sigma L / E to 1e-6", [](const Progress& p) {
                 return aspect(1e-4, {true, false, false}, p);
               }});
  s.push_back({"tetrahedra of aspect 1e4, needles", "stretch sigma L / E to 1e-6", [](const Progress& p) {
                 return aspect(1e-4, {false, true, true}, p);
               }});
  s.push_back(
      {"tetrahedra of aspect 1e10", "refused, naming the tetrahedron", [](const Progress& p) {
         return refused([&] { mechanics::solveTets(block(1e-10, {true, false, false}), {}, p); }, {"tetrahedron"});
       }});

  s.push_back({"duplicate mesh-free sites", "left out, with a note", [](const Progress& p) {
                 Eigen::Matrix3Xd at = lattice(6, 2);
                 at.conservativeResize(3, at.cols() + 2);
                 at.col(at.cols() - 2) = at.col(3);
                 at.col(at.cols() - 1) = at.col(5) + Vector3d(1e-9, 0, 0);
                 return sites(placed(Kernel::Mls, 1, at), "each lies on another", p);
               }});
  s.push_back({"mesh-free sites in one plane", "the fit keeps what the plane shows, with a note",
               [](const Progress& p) { return sites(placed(Kernel::Mls, 2, lattice(12, 1)), "in one plane", p); }});
  s.push_back({"too few mesh-free sites near a node", "the fit keeps fewer terms, with a note",
               [](const Progress& p) { return sites(placed(Kernel::Mls, 2, lattice(3, 1)), "too few", p); }});
  s.push_back({"mesh-free sites off the body", "refused", [](const Progress& p) {
                 return refused([&] { sites(placed(Kernel::Wendland, 1, Vector3d(0.2, 0, 0)), "", p); },
                                {"lies in the body"});
               }});
  return s;
}

}  // namespace glisson::study
