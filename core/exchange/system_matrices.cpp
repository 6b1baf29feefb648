#include "exchange/system_matrices.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "exchange/write_text.h"
#include "mechanics/hex_element.h"
#include "retraction/body.h"

namespace glisson::exchange {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int maxUnknowns = 1'200'000;

/// Adds the lower triangle of an element matrix (24 × 24).
void addElement(const std::array<int, 8>& nodes, const mechanics::HexMatrix& matrix, double factor, Triplets& to) {
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) {
          const int row = 3 * nodes[static_cast<std::size_t>(a)] + c;
          const int column = 3 * nodes[static_cast<std::size_t>(b)] + d;
          const double value = factor * matrix(3 * a + c, 3 * b + d);
          if (row >= column && value != 0.0) to.emplace_back(row, column, value);
        }
}

SparseMatrix assembled(int unknowns, const Triplets& triplets) {
  SparseMatrix m(unknowns, unknowns);
  m.setFromTriplets(triplets.begin(), triplets.end());
  return m;
}

/// Element matrices turned from the grid's axes into the patient's.
mechanics::HexMatrix turned(const mechanics::HexMatrix& local, const Eigen::Matrix3d& direction) {
  mechanics::HexMatrix out;
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      out.block<3, 3>(3 * a, 3 * b) = direction * local.block<3, 3>(3 * a, 3 * b) * direction.transpose();
  return out;
}

void addFixations(const std::vector<mechanics::Fixation>& fixations, const Eigen::Matrix3d& direction,
                  SystemMatrices& s) {
  std::map<int, double> held;
  for (const mechanics::Fixation& f : fixations) {
    const Eigen::Vector3d value = direction * f.value_m;
    for (int axis = 0; axis < 3; ++axis) {
      bool all = true, any = false;
      for (int local = 0; local < 3; ++local) {
        if (std::abs(direction(axis, local)) < 1e-6) continue;
        all = all && f.axis[static_cast<std::size_t>(local)];
        any = any || f.axis[static_cast<std::size_t>(local)];
      }
      if (any && !all)
        throw BadInput("a support holds a direction that is oblique to the patient's axes; its matrix cannot be written");
      if (any) held[3 * f.node + axis] = value[axis];
    }
  }
  for (const auto& [unknown, value] : held) {
    s.fixed.push_back(unknown);
    s.fixed_m.push_back(value);
  }
}

}  // namespace

SystemMatrices systemMatrices(const retraction::Model& model, const retraction::Setup& setup) {
  if (setup.model.kind == retraction::ModelKind::FemTet)
    throw BadInput("matrices are written for voxel hexahedra; this scene's model is tetrahedra (fem-tet)");
  const retraction::Body body(model);
  const mechanics::VoxelMesh& mesh = body.mesh();
  const mechanics::VoxelBody& voxels = body.voxels();
  const int unknowns = 3 * mesh.nodeCount();
  if (unknowns > maxUnknowns)
    throw BadInput("the matrices of " + std::to_string(unknowns) +
                   " unknowns would take gigabytes as text; use larger cells (cell_mm)");
  const retraction::MechanicsScene scene = retraction::toMechanics(body, model, setup);
  const Eigen::Matrix3d& R = model.youngs_kPa.grid.direction;
  const mechanics::HexMatrix K0 =
      turned(mechanics::hexStiffness(setup.model.element, voxels.poisson, voxels.h_m), R);
  const Eigen::Matrix<double, 8, 8> m0 = mechanics::hexMass(voxels.h_m);
  mechanics::HexMatrix M0 = mechanics::HexMatrix::Zero();
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) M0.block<3, 3>(3 * a, 3 * b).diagonal().setConstant(m0(a, b));

  SystemMatrices s;
  s.nodes_lps_mm.resize(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) s.nodes_lps_mm.col(n) = body.nodePosition_mm(n);
  Triplets K, M;
  for (int c = 0; c < mesh.cellCount(); ++c) {
    const Eigen::Vector3i ijk = mesh.cellOf(c);
    const std::array<int, 8> nodes = mesh.nodesOf(c);
    addElement(nodes, K0, voxels.E_Pa[voxels.cell(ijk.x(), ijk.y(), ijk.z())], K);
    addElement(nodes, M0, voxels.density_kg_m3, M);
  }
  s.K_N_m = assembled(unknowns, K);
  s.M_kg = assembled(unknowns, M);
  Triplets springs;
  for (const mechanics::Spring& spring : scene.problem.supports.springs) {
    const Eigen::Matrix3d k = R * spring.k_N_m * R.transpose();
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d <= c; ++d)
        if (k(c, d) != 0.0) springs.emplace_back(3 * spring.node + c, 3 * spring.node + d, k(c, d));
  }
  s.springs_N_m = assembled(unknowns, springs);
  const mechanics::NodalField f = R * scene.problem.f_N;
  s.f_N = Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
  addFixations(scene.problem.supports.fixations, R, s);
  return s;
}

std::vector<std::filesystem::path> writeSystemMatrices(const std::filesystem::path& folder, const SystemMatrices& s) {
  const std::string ordering =
      "ordering: unknown 3 n + a (from 0) is the displacement of node n of nodes.csv along LPS axis a (x to the left, y "
      "to posterior, z to superior)";
  const std::string use = "K u = f on the unknowns not in fixed.csv, with K = K.mtx + springs.mtx; u in m, f in N";
  const auto note = [&](const std::string& what) { return std::vector<std::string>{what, ordering, use}; };
  writeMatrixMarket(folder / "K.mtx", s.K_N_m, note("stiffness of the voxel hexahedra, unit N/m, supports left out"));
  writeMatrixMarket(folder / "M.mtx", s.M_kg, note("consistent mass, unit kg"));
  writeMatrixMarket(folder / "springs.mtx", s.springs_N_m, note("elastic supports, unit N/m"));
  writeMatrixMarket(folder / "f.mtx", s.f_N, note("sum of all loads, unit N"));
  std::string nodes = "node,x_lps_mm,y_lps_mm,z_lps_mm\n";
  for (Eigen::Index n = 0; n < s.nodes_lps_mm.cols(); ++n)
    nodes += std::to_string(n) + "," + number(s.nodes_lps_mm(0, n)) + "," + number(s.nodes_lps_mm(1, n)) + "," +
             number(s.nodes_lps_mm(2, n)) + "\n";
  writeBytes(folder / "nodes.csv", nodes);
  std::string fixed = "unknown,displacement_m\n";
  for (std::size_t n = 0; n < s.fixed.size(); ++n)
    fixed += std::to_string(s.fixed[n]) + "," + number(s.fixed_m[n]) + "\n";
  writeBytes(folder / "fixed.csv", fixed);
  return {folder / "K.mtx",       folder / "M.mtx",     folder / "springs.mtx",
          folder / "f.mtx",       folder / "nodes.csv", folder / "fixed.csv"};
}

}  // namespace glisson::exchange
