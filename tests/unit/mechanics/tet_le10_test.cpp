// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mechanics/static_solve.h"
#include "mechanics/tet_element.h"
#include "mechanics/tet_solve.h"
#include "scenes.h"

// NAFEMS LE10, thick elliptic plate: a quarter between the ellipses (2, 1) and (3.25, 2.75) m, 0.6 m thick, E 210 GPa,
// ν 0.3, 1 MPa on the upper surface. y = 0 held along y, x = 0 along x, the outer wall along x and y, and the middle
// line of the outer wall along z. Target: σyy = −5.38 MPa at D = (2, 0, 0.6), the inner end of the upper surface.
namespace glisson::mechanics {
namespace {

Eigen::Vector3d onPlate(const Eigen::Vector3d& unit) {
  const double r = unit.x();
  const double angle = unit.y() * std::numbers::pi / 2;
  return {(2 + 1.25 * r) * std::cos(angle), (1 + 1.75 * r) * std::sin(angle), 0.6 * unit.z()};
}

/// σyy at D, MPa: the mean over the tetrahedra that meet there.
double stressAtD_MPa(const Eigen::Vector3i& cells, bool quadratic) {
  const VoxelBody body = test::box(cells, {1, 1, 1}, 210e9, 0.3);
  TetProblem p;
  p.mesh = tetrahedra(body, VoxelMesh(body));
  if (quadratic) p.mesh = withMiddles(p.mesh);
  p.poisson = 0.3;
  const Eigen::Matrix3Xd unit = p.mesh.nodes_m;
  for (int node = 0; node < p.mesh.nodeCount(); ++node) {
    const Eigen::Vector3d x = unit.col(node);
    const bool outer = x.x() > 1 - 1e-9;
    const Fixation f{node,
                     {outer || x.y() > 1 - 1e-9, outer || x.y() < 1e-9, outer && std::abs(x.z() - 0.5) < 1e-9},
                     Eigen::Vector3d::Zero()};
    if (f.axis[0] || f.axis[1] || f.axis[2]) p.supports.fixations.push_back(f);
    p.mesh.nodes_m.col(node) = onPlate(x);
  }
  std::vector<TetFace> top;
  for (const TetFace& face : exteriorFaces(p.mesh)) {
    bool all = true;
    for (const int node : nodesOf(p.mesh, face)) all = all && unit(2, node) > 1 - 1e-9;
    if (all) top.push_back(face);
  }
  p.f_N = tractionForce(p.mesh, top, {0, 0, -1e6});
  const Solution s = solveTets(p);
  EXPECT_TRUE(s.report.converged());
  double sum = 0;
  int count = 0;
  const std::array<Eigen::Vector3d, 4> corner = {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    for (int a = 0; a < 4; ++a)
      if ((p.mesh.nodes_m.col(p.mesh.tets(a, t)) - Eigen::Vector3d(2, 0, 0.6)).norm() < 1e-9) {
        sum += tetStress_Pa(p.mesh, t, 0.3, s.u_m, corner[static_cast<std::size_t>(a)])[1];
        ++count;
      }
  return 1e-6 * sum / count;
}

TEST(NafemsLe10, QuadraticTetrahedraGiveTheStressAtD) {
  const double coarse = stressAtD_MPa({6, 8, 2}, true);
  const double fine = stressAtD_MPa({10, 14, 4}, true);
  EXPECT_NEAR(fine, -5.38, 0.02 * 5.38);
  EXPECT_NEAR(coarse, -5.38, 0.06 * 5.38);
}

}  // namespace
}  // namespace glisson::mechanics
