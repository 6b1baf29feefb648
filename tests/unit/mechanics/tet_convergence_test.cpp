// SPDX-License-Identifier: GPL-3.0-or-later

// Tetrahedra against a manufactured solution: u = φ v, φ = sin πx sin πy sin πz on the unit cube, zero on its surface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "mechanics/tet_element.h"
#include "mechanics/tet_mesh.h"
#include "mechanics/tet_solve.h"
#include "scenes.h"

namespace glisson::mechanics {
namespace {

using Eigen::Vector3d;

constexpr double nu = 0.3;
constexpr double pi = std::numbers::pi;
const Vector3d v(1, -0.5, 0.7);

double phi(const Vector3d& x) {
  return std::sin(pi * x.x()) * std::sin(pi * x.y()) * std::sin(pi * x.z());
}

/// −div σ(φ v) at E = 1.
Vector3d force(const Vector3d& x) {
  const double mu = 0.5 / (1 + nu);
  const double lambda = nu / ((1 + nu) * (1 - 2 * nu));
  Eigen::Matrix3d hessian;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      hessian(i, j) = i == j ? -pi * pi * phi(x)
                             : pi * pi * std::cos(pi * x[i]) * std::cos(pi * x[j]) * std::sin(pi * x[3 - i - j]);
  return 3 * pi * pi * mu * phi(x) * v - (lambda + mu) * hessian * v;
}

/// use(ξ, weight in m³) at Gauss points of the cube folded onto tetrahedron t, exact to degree 5.
void atGaussPoints(const TetMesh& mesh, int t, const std::function<void(const Vector3d&, double)>& use) {
  const double a = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
  const double b = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
  const std::array<double, 4> place = {-b, -a, a, b};
  const double heavy = (18 + std::sqrt(30.0)) / 72;
  const double light = (18 - std::sqrt(30.0)) / 72;
  const std::array<double, 4> weight = {light, heavy, heavy, light};
  double volume = 0;
  for (const TetPoint& g : tetPoints(mesh, t)) volume += g.volume_m3;
  for (std::size_t g = 0; g < 64; ++g) {
    const double x = 0.5 * (1 + place[g % 4]);
    const double y = 0.5 * (1 + place[g / 4 % 4]);
    const double z = 0.5 * (1 + place[g / 16]);
    const double w = weight[g % 4] * weight[g / 4 % 4] * weight[g / 16];
    use({x, y * (1 - x), z * (1 - x) * (1 - y)}, 6 * volume * w * (1 - x) * (1 - x) * (1 - y));
  }
}

/// A nodal field where tetrahedron t has the shape functions N.
Vector3d valueOf(const TetMesh& mesh, int t, const Eigen::VectorXd& N, const Eigen::Matrix3Xd& field) {
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index a = 0; a < N.size(); ++a) sum += N[a] * field.col(mesh.tets(a, t));
  return sum;
}

TetProblem problem(int n, bool quadratic) {
  TetProblem p;
  const VoxelBody body = test::box({n, n, n}, {1, 1, 1}, 1, nu);
  p.mesh = tetrahedra(body, VoxelMesh(body));
  if (quadratic) p.mesh = withMiddles(p.mesh);
  p.poisson = nu;
  for (int node = 0; node < p.mesh.nodeCount(); ++node) {
    const Vector3d x = p.mesh.nodes_m.col(node);
    if (x.minCoeff() < 1e-12 || x.maxCoeff() > 1 - 1e-12)
      p.supports.fixations.push_back({node, {true, true, true}, Vector3d::Zero()});
  }
  p.f_N = NodalField::Zero(3, p.mesh.nodeCount());
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    atGaussPoints(p.mesh, t, [&](const Vector3d& xi, double w) {
      const Eigen::VectorXd N = tetShape(quadratic, xi);
      const Vector3d f = force(valueOf(p.mesh, t, N, p.mesh.nodes_m));
      for (Eigen::Index a = 0; a < N.size(); ++a) p.f_N.col(p.mesh.tets(a, t)) += w * N[a] * f;
    });
  return p;
}

/// Of the displacement, in L².
double errorOf(const TetProblem& p, bool quadratic) {
  const Solution s = solveTets(p);
  double sum = 0;
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    atGaussPoints(p.mesh, t, [&](const Vector3d& xi, double w) {
      const Eigen::VectorXd N = tetShape(quadratic, xi);
      sum += w * (valueOf(p.mesh, t, N, s.u_m) - phi(valueOf(p.mesh, t, N, p.mesh.nodes_m)) * v).squaredNorm();
    });
  return std::sqrt(sum);
}

TEST(Tetrahedra, DisplacementConvergesWithTheThirdOrder) {
  for (const bool quadratic : {false, true}) {
    double previous = 0;
    for (const int n : {3, 6, 9}) {
      const double error = errorOf(problem(n, quadratic), quadratic);
      if (previous > 0) {
        const double order = std::log(previous / error) / std::log(n == 6 ? 2.0 : 1.5);
        EXPECT_GT(order, quadratic ? 2.6 : 1.5);
        EXPECT_LT(order, quadratic ? 3.6 : 2.5);
      }
      previous = error;
    }
  }
}

}  // namespace
}  // namespace glisson::mechanics
