// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace glisson::mechanics {

/// A solid made of equal box-shaped cells, one Young's modulus each. SI units, the grid's own axes.
struct VoxelBody {
  Eigen::Vector3i cells = Eigen::Vector3i::Zero();  ///< nx, ny, nz
  Eigen::Vector3d h_m = Eigen::Vector3d::Zero();    ///< cell edge lengths, m
  std::vector<double> E_Pa;                         ///< nx·ny·nz, x fastest; 0 = empty
  double poisson = 0.45;                            ///< in (−1, 0.5)
  double density_kg_m3 = 1060.0;

  std::size_t cell(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(cells.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(cells.x()) +
           static_cast<std::size_t>(i);
  }
};

/// The nodes (corners) of the non-empty cells, numbered 0 .. nodeCount−1 in lattice order (x fastest). Node (i, j, k)
/// of the (nx+1)(ny+1)(nz+1) lattice lies at (i, j, k) ∘ h_m. Local corner a of a cell is at (a & 1, a >> 1 & 1, a >> 2
/// & 1).
class VoxelMesh {
 public:
  /// Throws BadInput naming the cell (i, j, k) where E is negative or not finite, poisson outside (−1, 0.5), density
  /// not positive, no cell filled.
  explicit VoxelMesh(const VoxelBody& body);

  int nodeCount() const { return static_cast<int>(lattice_.size()); }
  int cellCount() const { return static_cast<int>(filled_.size()); }
  /// Node at lattice position, −1 where no filled cell touches it.
  int nodeAt(int i, int j, int k) const;
  Eigen::Vector3i latticeOf(int node) const { return lattice_[static_cast<std::size_t>(node)]; }
  Eigen::Vector3d position_m(int node) const { return latticeOf(node).cast<double>().cwiseProduct(h_m_); }
  /// Filled cells by (i, j, k), in lattice order.
  Eigen::Vector3i cellOf(int filledCell) const { return filled_[static_cast<std::size_t>(filledCell)]; }
  std::array<int, 8> nodesOf(int filledCell) const;
  /// False outside the grid.
  bool isFilled(int i, int j, int k) const;
  const Eigen::Vector3d& h_m() const { return h_m_; }
  const Eigen::Vector3i& cells() const { return cells_; }

 private:
  Eigen::Vector3i cells_;
  Eigen::Vector3d h_m_;
  std::vector<int> nodeOfLattice_;
  std::vector<Eigen::Vector3i> lattice_;
  std::vector<Eigen::Vector3i> filled_;
};

/// 3 × nodeCount: a displacement (m), a force (N) or a velocity (m/s) per node.
using NodalField = Eigen::Matrix3Xd;

/// A node held at a prescribed displacement along some axes.
struct Fixation {
  int node = 0;
  std::array<bool, 3> axis = {true, true, true};
  Eigen::Vector3d value_m = Eigen::Vector3d::Zero();
};

/// A linear spring to ground: force = −k u, k symmetric positive semi-definite, N/m.
struct Spring {
  int node = 0;
  Eigen::Matrix3d k_N_m = Eigen::Matrix3d::Zero();
};

/// What holds a body; without any it floats.
struct Supports {
  std::vector<Fixation> fixations;
  std::vector<Spring> springs;  ///< several on one node add up
};

/// K u = f on a voxel body with supports. K is never stored: one modulus per cell is enough.
struct Problem {
  VoxelBody body;
  Supports supports;
  NodalField f_N;  ///< 3 × nodeCount of VoxelMesh(body)
};

/// How a solve ended. Only Converged results are drawn unmarked.
enum class SolveStatus { Converged, StoppedAtLimit, Indefinite, NotFinite };

/// How a solve went.
struct SolveReport {
  std::string kind;  ///< "multigrid-pcg", "factorised", "cg", ... and why, where "auto" chose
  std::string why;
  SolveStatus status = SolveStatus::StoppedAtLimit;
  int iterations = 0;
  double residual = 0.0;  ///< true relative residual ‖f − K u‖ / ‖f‖, recomputed at the end
  double tolerance = 0.0;
  double seconds = 0.0;
  Diagnostics diagnostics;  ///< what the user should know of it: another solver than the first had to take over
  bool converged() const { return status == SolveStatus::Converged; }
};

/// Hexahedron formulation: nine incompatible modes (condensed), B-bar, or plain trilinear full integration.
enum class HexElement { Incompatible, BBar, H8 };

/// Method of a linear solve; Auto chooses by size and says why (SolveReport::why).
enum class SolverKind { Auto, Cg, Factorised, Multigrid };
/// Preconditioner of plain conjugate gradients.
enum class Preconditioner { None, Jacobi, BlockJacobi };

/// Method, element and accuracy of a linear solve.
struct SolverOptions {
  SolverKind kind = SolverKind::Auto;
  HexElement element = HexElement::Incompatible;
  Preconditioner preconditioner = Preconditioner::Jacobi;  ///< for Cg
  int iterations = 0;                                      ///< limit; 0 = a limit of the solver's own
  static constexpr double usualTolerance = 1e-8;
  double tolerance = usualTolerance;  ///< on the true relative residual
  bool toleranceAsked = false;        ///< the usual one is the user's word too, not the program's choice
  /// A tolerance that somebody asked for is taken as given; one that nobody did may suit the task.
  bool keepsTolerance() const { return toleranceAsked || tolerance != usualTolerance; }
};

/// Displacements and what follows from them.
struct Solution {
  NodalField u_m;
  NodalField reaction_N;  ///< at fixed degrees of freedom and springs: force of the supports on the body
  double energy_J = 0.0;  ///< ½ uᵀ K u, springs included
  SolveReport report;
};

}  // namespace glisson::mechanics
