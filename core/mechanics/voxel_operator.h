// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mechanics/hex_element.h"
#include "mechanics/lattice_operator.h"
#include "mechanics/problem.h"
#include "mechanics/supports.h"

namespace glisson::mechanics {

/// Stiffness and mass of a voxel body with supports, never assembled: K = Σ E_e K₀ + springs, fixed degrees of freedom
/// projected out. Nodal fields are 3 × nodeCount in the numbering of VoxelMesh. K is symmetric positive semi-definite;
/// without supports it has exactly six zero modes per component. All results are the same to the last bit with any
/// number of threads. Const members may be called from several threads at once.
class VoxelOperator {
 public:
  /// Throws BadInput as VoxelMesh does; BadInput where a support names a node outside the mesh, a value is not finite,
  /// two fixations of one degree of freedom disagree, or a spring is not symmetric positive semi-definite (1e-10).
  explicit VoxelOperator(const VoxelBody& body, HexElement element = HexElement::Incompatible,
                         const Supports& supports = {});

  const VoxelMesh& mesh() const { return mesh_; }
  const VoxelBody& body() const { return body_; }
  HexElement element() const { return element_; }
  const HexMatrix& K0() const { return K0_; }  ///< element stiffness for E = 1 Pa, N/m
  int dofs() const { return 3 * mesh_.nodeCount(); }

  /// y = P (K + springs) P u, N; P sets fixed degrees of freedom to 0. y is resized. Throws BadArgument on a wrong
  /// size.
  void apply(const NodalField& u_m, NodalField& y_N) const;
  NodalField apply(const NodalField& u_m) const;
  /// Internal forces of the cells alone: no springs, no fixations. Sums to zero force and zero moment.
  void applyFree(const NodalField& u_m, NodalField& y_N) const;
  NodalField applyFree(const NodalField& u_m) const;
  /// Force of the springs on the body, −k u; 0 at nodes without springs.
  NodalField springForce(const NodalField& u_m) const;

  /// Diagonal of K with springs, fixed degrees of freedom included, N/m; positive.
  NodalField diagonal() const;
  /// 3 × 3 diagonal blocks of K with springs, one per node, N/m; symmetric positive definite.
  std::vector<Eigen::Matrix3d> blockDiagonals() const;

  /// Consistent mass times v, kg · unit of v; fixations play no role.
  NodalField applyMass(const NodalField& v) const;
  /// Row sums of the consistent mass, kg per node; they add up to ρV.
  Eigen::VectorXd lumpedMass_kg() const;

  bool isFixed(int node, int axis) const { return dirichlet_.constrained(axis, node); }
  /// 3 × nodeCount.
  const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed() const { return dirichlet_.constrained; }
  int fixedCount() const { return fixedCount_; }
  /// Sets fixed degrees of freedom to 0.
  void project(NodalField& field) const;
  /// Prescribed displacement at fixed degrees of freedom, 0 elsewhere, m.
  const NodalField& prescribed_m() const { return dirichlet_.value_m; }
  /// Total spring per node that has any, ascending by node, N/m.
  const std::vector<Spring>& springs() const { return springs_; }

  /// The same operator on row storage, for solvers.
  const LatticeOperator<double>& lattice() const { return lattice_; }
  /// mass · M + stiffness · K on row storage, M the consistent mass (kg), K with springs; fixed degrees of freedom are
  /// projected out by its apply, not by its applyCells.
  LatticeOperator<double> implicitLattice(double mass, double stiffness) const;
  /// Between 3 × nodeCount and the three arrays of row storage (lattice().size() values, 0 where no node).
  void toSlots(const NodalField& field, double* slots) const;
  void fromSlots(const double* slots, NodalField& field) const;
  std::size_t slotOfNode(int node) const { return slotOfNode_[static_cast<std::size_t>(node)]; }

 private:
  void readSupports(const Supports& supports);

  VoxelBody body_;
  VoxelMesh mesh_;
  HexElement element_;
  HexMatrix K0_;
  LatticeOperator<double> lattice_;
  std::vector<std::size_t> slotOfNode_;
  DirichletData dirichlet_;
  std::vector<Spring> springs_;
  int fixedCount_ = 0;
};

}  // namespace glisson::mechanics
