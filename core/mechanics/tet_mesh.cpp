// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/tet_mesh.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "base/error.h"
#include "mechanics/tet_element.h"

namespace glisson::mechanics {

TetMesh tetrahedra(const VoxelBody& body, const VoxelMesh& mesh, TetPattern pattern) {
  // The paths from corner 0 to corner 7 along one axis after the other; odd permutations turn the other way round.
  constexpr std::array<std::array<int, 3>, 6> order = {
      {{{0, 1, 2}}, {{1, 2, 0}}, {{2, 0, 1}}, {{0, 2, 1}}, {{2, 1, 0}}, {{1, 0, 2}}}};
  TetMesh out;
  out.nodes_m.resize(3, mesh.nodeCount());
  for (int node = 0; node < mesh.nodeCount(); ++node) out.nodes_m.col(node) = mesh.position_m(node);
  out.tets.resize(4, 6 * mesh.cellCount());
  out.E_Pa.resize(6 * mesh.cellCount());
  int tet = 0;
  for (int e = 0; e < mesh.cellCount(); ++e) {
    const Eigen::Vector3i p = mesh.cellOf(e);
    const bool mirrored = pattern == TetPattern::Mirrored;
    const int mirror = !mirrored ? 0 : (p.x() & 1) | (p.y() & 1) << 1 | (p.z() & 1) << 2;
    const bool flipped = mirrored && ((p.x() + p.y() + p.z()) & 1) != 0;
    const std::array<int, 8> corner = mesh.nodesOf(e);
    for (std::size_t path = 0; path < 6; ++path, ++tet) {
      const int second = 1 << order[path][0];
      const int third = second | 1 << order[path][1];
      const std::array<int, 4> at = {0, second, third, 7};
      for (int a = 0; a < 4; ++a)
        out.tets(a, tet) = corner[static_cast<std::size_t>(at[static_cast<std::size_t>(a)] ^ mirror)];
      if ((path >= 3) != flipped) std::swap(out.tets(1, tet), out.tets(2, tet));
      out.E_Pa[tet] = body.E_Pa[body.cell(p.x(), p.y(), p.z())];
    }
  }
  return out;
}

TetMesh withMiddles(const TetMesh& linear) {
  if (linear.quadratic()) throw BadArgument("withMiddles: the tetrahedra have middle nodes already");
  TetMesh out;
  out.E_Pa = linear.E_Pa;
  out.tets.resize(10, linear.tetCount());
  out.tets.topRows<4>() = linear.tets;
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::Vector3d> added;
  for (int t = 0; t < linear.tetCount(); ++t)
    for (int e = 0; e < 6; ++e) {
      const auto& edge = tetEdges[static_cast<std::size_t>(e)];
      const std::pair<int, int> ends = std::minmax(int{linear.tets(edge[0], t)}, int{linear.tets(edge[1], t)});
      const auto [it, fresh] = middles.try_emplace(ends, linear.nodeCount() + static_cast<int>(added.size()));
      if (fresh) added.push_back(0.5 * (linear.nodes_m.col(ends.first) + linear.nodes_m.col(ends.second)));
      out.tets(4 + e, t) = it->second;
    }
  out.nodes_m.resize(3, linear.nodeCount() + static_cast<Eigen::Index>(added.size()));
  out.nodes_m.leftCols(linear.nodeCount()) = linear.nodes_m;
  for (std::size_t i = 0; i < added.size(); ++i)
    out.nodes_m.col(linear.nodeCount() + static_cast<Eigen::Index>(i)) = added[i];
  return out;
}

std::vector<TetFace> exteriorFaces(const TetMesh& mesh) {
  struct Sorted {
    std::array<int, 3> corners;
    TetFace face;
  };
  std::vector<Sorted> all;
  all.reserve(4 * static_cast<std::size_t>(mesh.tetCount()));
  for (int t = 0; t < mesh.tetCount(); ++t)
    for (int f = 0; f < 4; ++f) {
      const auto& local = tetFaces[static_cast<std::size_t>(f)];
      std::array<int, 3> c = {mesh.tets(local[0], t), mesh.tets(local[1], t), mesh.tets(local[2], t)};
      std::sort(c.begin(), c.end());
      all.push_back({c, {t, f}});
    }
  std::stable_sort(all.begin(), all.end(), [](const Sorted& a, const Sorted& b) { return a.corners < b.corners; });
  std::vector<TetFace> faces;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].corners == all[i].corners) ++end;
    if (end - i == 1) faces.push_back(all[i].face);
    i = end;
  }
  return faces;
}

std::vector<int> nodesOf(const TetMesh& mesh, const TetFace& face) {
  const auto& local = tetFaces[static_cast<std::size_t>(face.face)];
  std::vector<int> nodes;
  for (const int c : local) nodes.push_back(mesh.tets(c, face.tet));
  if (!mesh.quadratic()) return nodes;
  for (std::size_t i = 0; i < 3; ++i)
    for (int e = 0; e < 6; ++e) {
      const auto& edge = tetEdges[static_cast<std::size_t>(e)];
      if (std::minmax(edge[0], edge[1]) == std::minmax(local[i], local[(i + 1) % 3]))
        nodes.push_back(mesh.tets(4 + e, face.tet));
    }
  return nodes;
}

Eigen::VectorXd tetShape(bool quadratic, const Eigen::Vector3d& xi) {
  const Eigen::Vector4d L(1 - xi.sum(), xi.x(), xi.y(), xi.z());
  if (!quadratic) return L;
  Eigen::VectorXd N(10);
  for (int a = 0; a < 4; ++a) N[a] = L[a] * (2 * L[a] - 1);
  for (int e = 0; e < 6; ++e) {
    const auto& edge = tetEdges[static_cast<std::size_t>(e)];
    N[4 + e] = 4 * L[edge[0]] * L[edge[1]];
  }
  return N;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> tetShapeDerivatives(bool quadratic, const Eigen::Vector3d& xi) {
  const Eigen::Vector4d L(1 - xi.sum(), xi.x(), xi.y(), xi.z());
  Eigen::Matrix<double, 4, 3> dL;
  dL << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  if (!quadratic) return dL;
  Eigen::Matrix<double, Eigen::Dynamic, 3> dN(10, 3);
  for (int a = 0; a < 4; ++a) dN.row(a) = (4 * L[a] - 1) * dL.row(a);
  for (int e = 0; e < 6; ++e) {
    const auto& edge = tetEdges[static_cast<std::size_t>(e)];
    dN.row(4 + e) = 4 * (L[edge[0]] * dL.row(edge[1]) + L[edge[1]] * dL.row(edge[0]));
  }
  return dN;
}

NodalField bodyForce(const TetMesh& mesh, const Eigen::Vector3d& density_N_m3) {
  NodalField f = NodalField::Zero(3, mesh.nodeCount());
  for (int t = 0; t < mesh.tetCount(); ++t)
    for (const TetPoint& point : tetPoints(mesh, t))
      for (Eigen::Index a = 0; a < mesh.tets.rows(); ++a)
        f.col(mesh.tets(a, t)) += point.volume_m3 * point.N[a] * density_N_m3;
  return f;
}

NodalField tractionForce(const TetMesh& mesh, const std::vector<TetFace>& faces, const Eigen::Vector3d& traction_Pa) {
  NodalField f = NodalField::Zero(3, mesh.nodeCount());
  for (const TetFace& face : faces) {
    const std::vector<int> nodes = nodesOf(mesh, face);
    // Three points, exact for polynomials of degree 2.
    for (int g = 0; g < 3; ++g) {
      Eigen::Vector3d L = Eigen::Vector3d::Constant(1.0 / 6);
      L[g] = 2.0 / 3;
      // The face is the side ζ = 0 of a tetrahedron with the same shape functions.
      const Eigen::Vector3d xi(L[1], L[2], 0);
      const Eigen::VectorXd N = tetShape(mesh.quadratic(), xi);
      const auto dN = tetShapeDerivatives(mesh.quadratic(), xi);
      constexpr std::array<int, 6> shape = {0, 1, 2, 4, 5, 6};
      Eigen::Vector3d a = Eigen::Vector3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        a += dN(shape[i], 0) * mesh.nodes_m.col(nodes[i]);
        b += dN(shape[i], 1) * mesh.nodes_m.col(nodes[i]);
      }
      const double area = a.cross(b).norm() / 6;
      for (std::size_t i = 0; i < nodes.size(); ++i) f.col(nodes[i]) += area * N[shape[i]] * traction_Pa;
    }
  }
  return f;
}

}  // namespace glisson::mechanics
