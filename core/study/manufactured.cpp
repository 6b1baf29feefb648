// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/detail/manufactured.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.h"
#include "mechanics/hex_element.h"
#include "mechanics/hyperelastic.h"
#include "mechanics/newton_solve.h"
#include "mechanics/static_solve.h"

namespace glisson::study {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double pi = std::numbers::pi, poisson = 0.3;
const Vector3d direction(1.0, 0.5, -0.7);

double amplitudeOf(Manufactured kind) {
  return kind == Manufactured::FiniteStrain ? 0.08 : 1e-3;
}

Vector3d displacement(Manufactured kind, const Vector3d& x) {
  return amplitudeOf(kind) * std::sin(pi * x.x()) * std::sin(pi * x.y()) * std::sin(pi * x.z()) * direction;
}

/// ∂u_i / ∂x_j.
Matrix3d gradient(Manufactured kind, const Vector3d& x) {
  Vector3d g;
  for (int i = 0; i < 3; ++i)
    g[i] = pi * std::cos(pi * x[i]) * std::sin(pi * x[(i + 1) % 3]) * std::sin(pi * x[(i + 2) % 3]);
  return amplitudeOf(kind) * direction * g.transpose();
}

/// Young's modulus, Pa.
double modulus(Manufactured kind, const Vector3d& x) {
  if (kind == Manufactured::FiniteStrain) return 1.0;
  return 1.0 + 0.8 * std::sin(2 * pi * x.x()) * std::sin(2 * pi * x.y()) * std::sin(2 * pi * x.z());
}

/// First Piola-Kirchhoff stress, Pa, written down from the material's energy and not by the solver's own code.
Matrix3d stress(Manufactured kind, const Vector3d& x) {
  const Matrix3d H = gradient(kind, x);
  const double lambda = modulus(kind, x) * mechanics::lameLambda(poisson);
  const double mu = modulus(kind, x) * mechanics::lameMu(poisson);
  if (kind == Manufactured::VaryingModulus) return lambda * H.trace() * Matrix3d::Identity() + mu * (H + H.transpose());
  const Matrix3d F = Matrix3d::Identity() + H, inverse = F.inverse().transpose();
  return mu * (F - inverse) + lambda * std::log(F.determinant()) * inverse;
}

/// −div P, N/m³.
Vector3d bodyForce(Manufactured kind, const Vector3d& x) {
  constexpr double step = 1e-4;
  Vector3d f = Vector3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const Vector3d d = step * Vector3d::Unit(j);
    f -= (stress(kind, x + d).col(j) - stress(kind, x - d).col(j)) / (2 * step);
  }
  return f;
}

mechanics::Problem problemOf(Manufactured kind, int n) {
  mechanics::Problem p;
  p.body.cells = Eigen::Vector3i::Constant(n);
  p.body.h_m = Vector3d::Constant(1.0 / n);
  p.body.poisson = poisson;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) p.body.E_Pa.push_back(modulus(kind, Vector3d(i + 0.5, j + 0.5, k + 0.5) / n));
  const mechanics::VoxelMesh mesh(p.body);
  p.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i at = mesh.latticeOf(node);
    if (at.minCoeff() == 0 || at.maxCoeff() == n) p.supports.fixations.push_back({node, {true, true, true}, {0, 0, 0}});
  }
  const std::array<double, 3> point = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const std::array<double, 3> weight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const std::array<int, 8> nodes = mesh.nodesOf(e);
    for (std::size_t g = 0; g < 27; ++g) {
      const Vector3d xi(point[g % 3], point[g / 3 % 3], point[g / 9]);
      const Vector3d x = (mesh.cellOf(e).cast<double>() + 0.5 * (xi + Vector3d::Ones())) / n;
      const double w = weight[g % 3] * weight[g / 3 % 3] * weight[g / 9] / (1.0 * n * n * n);
      const Vector3d force = w * bodyForce(kind, x);
      const auto shape = mechanics::hexShape(xi);
      for (int a = 0; a < 8; ++a) p.f_N.col(nodes[static_cast<std::size_t>(a)]) += shape[a] * force;
    }
  }
  return p;
}

/// Largest error over the nodes, over the largest displacement chosen.
double errorWith(Manufactured kind, int n, bool& converged, const Progress& progress) {
  const mechanics::Problem p = problemOf(kind, n);
  mechanics::SolverOptions options;
  options.tolerance = 1e-9;
  const mechanics::Solution s =
      kind == Manufactured::FiniteStrain
          ? mechanics::solveLargeDeformation(p, mechanics::LargeDeformationKind::Hyperelastic, options, progress)
          : mechanics::solveStatic(p, options, progress);
  converged = converged && s.report.converged();
  const mechanics::VoxelMesh mesh(p.body);
  double error = 0.0;
  for (int node = 0; node < mesh.nodeCount(); ++node)
    error = std::max(error, (s.u_m.col(node) - displacement(kind, mesh.position_m(node))).norm());
  return error / (amplitudeOf(kind) * direction.norm());
}

}  // namespace

ManufacturedResult solveManufactured(Manufactured kind, int cells, const Progress& progress) {
  if (cells < 4 || cells % 2 != 0)
    throw BadArgument("a manufactured solution needs an even number of cells, at least 4");
  ManufacturedResult r;
  r.what =
      kind == Manufactured::FiniteStrain ? "finite strain, neo-Hookean" : "linear, modulus varying by a factor of 9";
  r.coarse = cells;
  r.fine = 2 * cells;
  r.converged = true;
  r.coarseError = errorWith(kind, r.coarse, r.converged, progress.part(0.0, 0.2));
  r.fineError = errorWith(kind, r.fine, r.converged, progress.part(0.2, 1.0));
  r.order = std::log2(r.coarseError / r.fineError);
  return r;
}

}  // namespace glisson::study
