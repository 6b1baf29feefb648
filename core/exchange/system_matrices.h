#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "exchange/matrix_market.h"
#include "retraction/setup.h"
#include "retraction/simulate.h"

namespace glisson::exchange {

/// The equations K u = f of a body of voxel hexahedra, in the patient's axes. Unknown 3 n + a is the displacement of
/// node n along LPS axis a; nodes are the filled cells' corners, i fastest, as in nodes_lps_mm. SI units.
struct SystemMatrices {
  Eigen::Matrix3Xd nodes_lps_mm;
  SparseMatrix K_N_m;        ///< lower triangle; elements only, positive semi-definite
  SparseMatrix M_kg;         ///< lower triangle; consistent mass, entries sum to 3 times the mass
  SparseMatrix springs_N_m;  ///< lower triangle; supports that give way: the stiffness of the body is K + springs
  Eigen::VectorXd f_N;       ///< all loads
  std::vector<int> fixed;    ///< unknowns that are held, ascending
  std::vector<double> fixed_m;  ///< at which displacement
};

/// Assembles what the solver applies without assembling. Throws BadInput where the model is not made of voxel
/// hexahedra (fem-tet), where a supported axis is no axis of the patient, or where the body has more than 1.2 million
/// unknowns.
SystemMatrices systemMatrices(const retraction::Model& model, const retraction::Setup& setup);

/// K.mtx, M.mtx, springs.mtx, f.mtx, nodes.csv and fixed.csv in a folder, units and ordering in their headers; returns
/// the files.
std::vector<std::filesystem::path> writeSystemMatrices(const std::filesystem::path& folder, const SystemMatrices& s);

}  // namespace glisson::exchange
