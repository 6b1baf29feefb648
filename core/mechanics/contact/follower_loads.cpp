#include "mechanics/contact/follower_loads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "mechanics/contact/contact_setup.h"

namespace glisson::mechanics {

std::vector<std::pair<int, double>> sharesOf(const VoxelMesh& mesh, const Eigen::Vector3d& p_m) {
  std::vector<std::pair<int, double>> shares;
  const auto cell = carrierCell(mesh, p_m);
  if (!cell) return shares;
  const Eigen::Vector3d xi = (p_m.cwiseQuotient(mesh.h_m()) - cell->cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3i corner(a & 1, a >> 1 & 1, a >> 2 & 1);
    double w = 1;
    for (int c = 0; c < 3; ++c) w *= corner[c] != 0 ? xi[c] : 1 - xi[c];
    const Eigen::Vector3i at = *cell + corner;
    if (w > 0) shares.emplace_back(mesh.nodeAt(at.x(), at.y(), at.z()), w);
  }
  return shares;
}

bool haveClosedOrHeldRim(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces,
                         const std::vector<Fixation>& fixations) {
  using Corner = std::array<int, 3>;
  const auto cornerAt = [&](const Eigen::Vector3d& p_m) {
    const Eigen::Vector3i i = p_m.cwiseQuotient(mesh.h_m()).array().round().cast<int>();
    return Corner{i.x(), i.y(), i.z()};
  };
  std::map<std::pair<Corner, Corner>, int> edges;
  for (const FollowerFace& f : faces)
    for (std::size_t c = 0; c < 4; ++c) {
      const Corner a = cornerAt(f.corner_m[c]), b = cornerAt(f.corner_m[(c + 1) % 4]);
      ++edges[std::minmax(a, b)];
    }
  std::vector<char> held(static_cast<std::size_t>(mesh.nodeCount()), 0);
  for (const Fixation& f : fixations)
    if (f.axis[0] && f.axis[1] && f.axis[2]) held[static_cast<std::size_t>(f.node)] = 1;
  const auto isHeld = [&](const Corner& c) {
    const int node = mesh.nodeAt(c[0], c[1], c[2]);
    return node >= 0 && held[static_cast<std::size_t>(node)] != 0;
  };
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edge.second > 1 || (isHeld(edge.first.first) && isHeld(edge.first.second));
  });
}

NodalField followerForces(const VoxelMesh& mesh, const std::vector<FollowerFace>& faces, const NodalField& u_m) {
  constexpr std::array<std::array<std::size_t, 3>, 4> triangles = {{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
  NodalField forces = NodalField::Zero(3, mesh.nodeCount());
  for (const FollowerFace& f : faces) {
    std::array<std::vector<std::pair<int, double>>, 4> shares;
    std::array<Eigen::Vector3d, 4> x = f.corner_m;
    for (std::size_t c = 0; c < 4; ++c) {
      shares[c] = sharesOf(mesh, f.corner_m[c]);
      for (const auto& [node, share] : shares[c]) x[c] += share * u_m.col(node);
    }
    // Both pairs of diagonals count half.
    for (const auto& t : triangles) {
      const Eigen::Vector3d area = 0.25 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
      for (const std::size_t c : t)
        for (const auto& [node, share] : shares[c]) forces.col(node) -= share * f.pressure_Pa / 3 * area;
    }
  }
  return forces;
}

}  // namespace glisson::mechanics
