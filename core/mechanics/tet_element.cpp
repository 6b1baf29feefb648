// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/tet_element.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "mechanics/hex_element.h"

namespace glisson::mechanics {
namespace {

constexpr double flattest = 1e-9;

/// Jacobian matrix ∂x/∂ξ; throws where the tetrahedron is flat or inverted there.
Eigen::Matrix3d jacobian(const TetMesh& mesh, int tet, const Eigen::Matrix<double, Eigen::Dynamic, 3>& dN) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (Eigen::Index a = 0; a < mesh.tets.rows(); ++a) J += mesh.nodes_m.col(mesh.tets(a, tet)) * dN.row(a);
  double longest = 0;
  for (const auto& edge : tetEdges)
    longest = std::max(longest,
                       (mesh.nodes_m.col(mesh.tets(edge[0], tet)) - mesh.nodes_m.col(mesh.tets(edge[1], tet))).norm());
  const double det = J.determinant();
  if (!(det > flattest * longest * longest * longest)) {
    std::ostringstream what;
    what << "tetrahedron " << tet << " is " << (det < 0 ? "inverted" : "flat") << ": Jacobian " << det
         << " m3 with a longest edge of " << longest << " m; improve the mesh there";
    throw BadInput(what.str());
  }
  return J;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> strainMatrix(const Eigen::Matrix<double, Eigen::Dynamic, 3>& G) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> B(6, 3 * G.rows());
  for (Eigen::Index a = 0; a < G.rows(); ++a) {
    const Eigen::Vector3d g = G.row(a).transpose();
    B.col(3 * a) << g.x(), 0, 0, g.y(), 0, g.z();
    B.col(3 * a + 1) << 0, g.y(), 0, g.x(), g.z(), 0;
    B.col(3 * a + 2) << 0, 0, g.z(), 0, g.y(), g.x();
  }
  return B;
}

}  // namespace

std::vector<TetPoint> tetPoints(const TetMesh& mesh, int tet) {
  const bool quadratic = mesh.quadratic();
  const int count = quadratic ? 4 : 1;
  const double near = (5 - std::sqrt(5.0)) / 20;
  const double far = (5 + 3 * std::sqrt(5.0)) / 20;
  std::vector<TetPoint> points;
  if (quadratic)  // a curved tetrahedron can be good at its points and folded at a corner
    for (int a = 0; a < 4; ++a)
      jacobian(mesh, tet, tetShapeDerivatives(true, a == 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d::Unit(a - 1)));
  for (int g = 0; g < count; ++g) {
    Eigen::Vector3d xi = Eigen::Vector3d::Constant(quadratic ? near : 0.25);
    if (quadratic && g > 0) xi[g - 1] = far;
    const auto dN = tetShapeDerivatives(quadratic, xi);
    const Eigen::Matrix3d J = jacobian(mesh, tet, dN);
    points.push_back({tetShape(quadratic, xi), dN * J.inverse(), J.determinant() / (6 * count)});
  }
  return points;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> tetGradients(const TetMesh& mesh, int tet, const Eigen::Vector3d& xi) {
  const auto dN = tetShapeDerivatives(mesh.quadratic(), xi);
  return dN * jacobian(mesh, tet, dN).inverse();
}

Eigen::MatrixXd tetStiffness(const TetMesh& mesh, int tet, double poisson) {
  const Eigen::Matrix<double, 6, 6> D = mesh.E_Pa[tet] * elasticity(poisson);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * mesh.tets.rows(), 3 * mesh.tets.rows());
  for (const TetPoint& point : tetPoints(mesh, tet)) {
    const Eigen::Matrix<double, 6, Eigen::Dynamic> B = strainMatrix(point.G);
    const Eigen::Matrix<double, 6, Eigen::Dynamic> DB = point.volume_m3 * (D * B);
    K.noalias() += B.transpose() * DB;
  }
  return 0.5 * (K + K.transpose());
}

Eigen::Matrix<double, 6, 1> tetStress_Pa(const TetMesh& mesh, int tet, double poisson, const NodalField& u_m,
                                         const Eigen::Vector3d& xi) {
  Eigen::VectorXd u(3 * mesh.tets.rows());
  for (Eigen::Index a = 0; a < mesh.tets.rows(); ++a) u.segment<3>(3 * a) = u_m.col(mesh.tets(a, tet));
  return mesh.E_Pa[tet] * elasticity(poisson) * (strainMatrix(tetGradients(mesh, tet, xi)) * u);
}

}  // namespace glisson::mechanics
