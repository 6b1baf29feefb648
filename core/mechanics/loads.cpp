// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/loads.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::mechanics {
namespace {

/// What a cell of the grid, with one layer of empty cells around it, is.
enum class Cell : unsigned char { Enclosed, Outside, Filled };

class CellMap {
 public:
  explicit CellMap(const VoxelMesh& mesh) : n_(mesh.cells() + Eigen::Vector3i::Constant(2)) {
    cell_.assign(at(n_ - Eigen::Vector3i::Ones()) + 1, Cell::Enclosed);
    const Eigen::Vector3i one = Eigen::Vector3i::Ones();
    for (int e = 0; e < mesh.cellCount(); ++e) cell_[at(mesh.cellOf(e) + one)] = Cell::Filled;
    std::vector<Eigen::Vector3i> stack = {Eigen::Vector3i::Zero()};
    cell_[0] = Cell::Outside;
    while (!stack.empty()) {
      const Eigen::Vector3i p = stack.back();
      stack.pop_back();
      for (int side = 0; side < 6; ++side) {
        Eigen::Vector3i q = p;
        q[side / 2] += side % 2 == 0 ? -1 : 1;
        if ((q.array() < 0).any() || (q.array() >= n_.array()).any()) continue;
        Cell& c = cell_[at(q)];
        if (c != Cell::Enclosed) continue;
        c = Cell::Outside;
        stack.push_back(q);
      }
    }
  }

  Cell beyond(const Eigen::Vector3i& cell, int side) const {
    Eigen::Vector3i q = cell + Eigen::Vector3i::Ones();
    q[side / 2] += side % 2 == 0 ? -1 : 1;
    return cell_[at(q)];
  }

 private:
  std::size_t at(const Eigen::Vector3i& p) const {
    return (static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(n_.y()) + static_cast<std::size_t>(p.y())) *
               static_cast<std::size_t>(n_.x()) +
           static_cast<std::size_t>(p.x());
  }
  Eigen::Vector3i n_;
  std::vector<Cell> cell_;
};

std::vector<Face> facesTowards(const VoxelMesh& mesh, Cell kind) {
  const CellMap map(mesh);
  std::vector<Face> faces;
  for (int e = 0; e < mesh.cellCount(); ++e)
    for (int side = 0; side < 6; ++side)
      if (map.beyond(mesh.cellOf(e), side) == kind) faces.push_back({e, side});
  return faces;
}

}  // namespace

Eigen::Vector3d faceNormal(int side) {
  return (side % 2 == 0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(side / 2);
}

double faceArea_m2(const VoxelMesh& mesh, int side) {
  return mesh.h_m().prod() / mesh.h_m()[side / 2];
}

Eigen::Vector3d faceCentre_m(const VoxelMesh& mesh, const Face& face) {
  const Eigen::Vector3d centre = mesh.cellOf(face.filledCell).cast<double>() + Eigen::Vector3d::Constant(0.5);
  return (centre + 0.5 * faceNormal(face.side)).cwiseProduct(mesh.h_m());
}

std::array<int, 4> faceNodes(const VoxelMesh& mesh, const Face& face) {
  const std::array<int, 8> nodes = mesh.nodesOf(face.filledCell);
  std::array<int, 4> found{};
  std::size_t count = 0;
  for (int a = 0; a < 8; ++a)
    if ((a >> (face.side / 2) & 1) == face.side % 2) found[count++] = nodes[static_cast<std::size_t>(a)];
  return found;
}

std::vector<Face> exteriorFaces(const VoxelMesh& mesh) {
  return facesTowards(mesh, Cell::Outside);
}
std::vector<Face> cavityFaces(const VoxelMesh& mesh) {
  return facesTowards(mesh, Cell::Enclosed);
}

NodalField tractionForce(const VoxelMesh& mesh, const std::vector<Face>& faces, const Eigen::Matrix3Xd& traction_Pa) {
  if (traction_Pa.cols() != static_cast<Eigen::Index>(faces.size()))
    throw BadArgument("tractionForce: " + std::to_string(traction_Pa.cols()) + " tractions for " +
                      std::to_string(faces.size()) + " faces");
  NodalField f = NodalField::Zero(3, mesh.nodeCount());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Eigen::Vector3d share =
        0.25 * faceArea_m2(mesh, faces[i].side) * traction_Pa.col(static_cast<Eigen::Index>(i));
    for (const int node : faceNodes(mesh, faces[i])) f.col(node) += share;
  }
  return f;
}

NodalField tractionForce(const VoxelMesh& mesh, const std::vector<Face>& faces, const Eigen::Vector3d& traction_Pa) {
  return tractionForce(mesh, faces,
                       Eigen::Matrix3Xd(traction_Pa.replicate(1, static_cast<Eigen::Index>(faces.size()))));
}

NodalField pressureForce(const VoxelMesh& mesh, const std::vector<Face>& faces, double pressure_Pa) {
  Eigen::Matrix3Xd traction(3, static_cast<Eigen::Index>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i)
    traction.col(static_cast<Eigen::Index>(i)) = -pressure_Pa * faceNormal(faces[i].side);
  return tractionForce(mesh, faces, traction);
}

NodalField bodyForce(const VoxelMesh& mesh, const Eigen::Vector3d& density_N_m3) {
  NodalField f = NodalField::Zero(3, mesh.nodeCount());
  const Eigen::Vector3d share = mesh.h_m().prod() / 8 * density_N_m3;
  for (int e = 0; e < mesh.cellCount(); ++e)
    for (const int node : mesh.nodesOf(e)) f.col(node) += share;
  return f;
}

std::vector<Foundation> foundations(const std::vector<Face>& faces, double k_N_m3, SpringDirection direction) {
  if (!(std::isfinite(k_N_m3) && k_N_m3 >= 0)) {
    std::ostringstream what;
    what << "a foundation of " << k_N_m3 << " N/m3 (" << k_N_m3 / N_m3_per_kPa_mm
         << " kPa/mm); the stiffness must be finite and not negative";
    throw BadInput(what.str());
  }
  std::vector<Foundation> all;
  for (const Face& face : faces) {
    const Eigen::Vector3d n = faceNormal(face.side);
    const Eigen::Matrix3d k =
        direction == SpringDirection::Normal ? Eigen::Matrix3d(n * n.transpose()) : Eigen::Matrix3d::Identity();
    all.push_back({face, k_N_m3 * k});
  }
  return all;
}

std::vector<Spring> faceSprings(const VoxelMesh& mesh, const std::vector<Face>& faces, double k_N_m3,
                                SpringDirection direction) {
  return faceSprings(mesh, foundations(faces, k_N_m3, direction));
}

std::vector<Spring> faceSprings(const VoxelMesh& mesh, const std::vector<Foundation>& foundations) {
  std::vector<Eigen::Matrix3d> atNode(static_cast<std::size_t>(mesh.nodeCount()), Eigen::Matrix3d::Zero());
  for (const Foundation& f : foundations)
    for (const int node : faceNodes(mesh, f.face))
      atNode[static_cast<std::size_t>(node)] += 0.25 * faceArea_m2(mesh, f.face.side) * f.k_N_m3;
  std::vector<Spring> springs;
  for (int node = 0; node < mesh.nodeCount(); ++node)
    if (!atNode[static_cast<std::size_t>(node)].isZero(0))
      springs.push_back({node, atNode[static_cast<std::size_t>(node)]});
  return springs;
}

std::vector<int> nodesOfFaces(const VoxelMesh& mesh, const std::vector<Face>& faces) {
  std::vector<int> nodes;
  for (const Face& face : faces)
    for (const int node : faceNodes(mesh, face)) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<Fixation> fix(const std::vector<int>& nodes, const std::array<bool, 3>& axis) {
  std::vector<Fixation> fixations;
  for (const int node : nodes) fixations.push_back({node, axis, Eigen::Vector3d::Zero()});
  return fixations;
}

}  // namespace glisson::mechanics
