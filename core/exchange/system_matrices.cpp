// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/system_matrices.h"

#include <cmath>
#include <map>
#include <ostream>

#include "base/error.h"
#include "exchange/detail/matrices.h"
#include "exchange/text_file.h"
#include "retraction/body.h"

namespace glisson::exchange {
namespace {

constexpr int maxUnknowns = 1'200'000;

/// Held unknowns in the patient's axes, with their displacement in m.
std::map<int, double> heldUnknowns(const std::vector<mechanics::Fixation>& fixations,
                                   const Eigen::Matrix3d& direction) {
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
        throw BadInput(
            "a support holds a direction that is oblique to the patient's axes; its matrix cannot be written");
      if (any) held[3 * f.node + axis] = value[axis];
    }
  }
  return held;
}

}  // namespace

std::vector<std::filesystem::path> writeSystem(const std::filesystem::path& folder, const retraction::Model& model,
                                               const retraction::Setup& setup) {
  if (setup.model.kind == retraction::ModelKind::FemTet)
    throw BadInput("matrices are written for voxel hexahedra; this scene's model is tetrahedra (fem-tet)");
  const retraction::Body body(model);
  const int nodes = body.mesh().nodeCount();
  if (3 * static_cast<long>(nodes) > maxUnknowns)
    throw BadInput("the matrices of " + std::to_string(3 * static_cast<long>(nodes)) +
                   " unknowns would take gigabytes as text; use larger cells (cell_mm)");
  const retraction::MechanicsScene scene = retraction::toMechanics(body, model, retraction::exportable(setup));
  std::vector<std::filesystem::path> files = writeMatrices(folder, body, setup.model.element);
  for (const auto& file : writeSpringMatrix(folder, body, scene.problem.supports)) files.push_back(file);
  const Eigen::Matrix3d& direction = model.youngs_kPa.grid.direction;
  const auto write = [&](const char* name, const auto& body_) {
    writeTextFile(folder / name, [&](std::ostream& out) { body_(out); });
    files.push_back(folder / name);
  };
  write("f.mtx", [&](std::ostream& out) {
    out << "%%MatrixMarket matrix array real general\n% sum of all loads, N; unknowns numbered as in K.mtx\n"
        << 3 * nodes << " 1\n";
    for (int n = 0; n < nodes; ++n) {
      const Eigen::Vector3d f = direction * scene.problem.f_N.col(n);
      for (int a = 0; a < 3; ++a) out << shortest(f[a]) << '\n';
    }
  });
  write("nodes.csv", [&](std::ostream& out) {
    out << "node,x_lps_mm,y_lps_mm,z_lps_mm\n";
    for (int n = 0; n < nodes; ++n) {
      const Eigen::Vector3d p = body.nodePosition_mm(n);
      out << n << ',' << shortest(p.x()) << ',' << shortest(p.y()) << ',' << shortest(p.z()) << '\n';
    }
  });
  write("fixed.csv", [&](std::ostream& out) {
    out << "unknown,displacement_m\n";
    for (const auto& [unknown, value_m] : heldUnknowns(scene.problem.supports.fixations, direction))
      out << unknown << ',' << shortest(value_m) << '\n';
  });
  return files;
}

}  // namespace glisson::exchange
