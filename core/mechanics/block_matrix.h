// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "mechanics/problem.h"

namespace glisson::mechanics {

/// Sparse symmetric matrix of 3 × 3 blocks, one block row per node, both triangles stored. Unknowns are numbered 3 node
/// + axis, as the columns of a NodalField lie in memory.
class BlockMatrix {
 public:
  /// Elements as node lists of equal length, nodesPerElement × elements; every pair of nodes of an element gets a
  /// block.
  BlockMatrix(int nodes, const Eigen::MatrixXi& elements);

  int nodes() const { return static_cast<int>(rowStart_.size()) - 1; }
  std::size_t blocks() const { return column_.size(); }
  void setZero();
  /// Adds an element's matrix, (3 m) × (3 m) for its m nodes.
  void add(const int* elementNodes, const Eigen::Ref<const Eigen::MatrixXd>& Ke);
  /// Adds to the diagonal block of a node.
  void addDiagonal(int node, const Eigen::Matrix3d& k);
  /// y = A x, thread-parallel, the same bits with any number of threads.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  Eigen::Matrix3d diagonalBlock(int node) const;

 private:
  friend class BlockFactor;
  std::size_t find(int row, int column) const;

  std::vector<std::size_t> rowStart_;
  std::vector<int> column_;  ///< ascending in each row
  std::vector<Eigen::Matrix3d> value_;
};

/// A = L Lᵀ of a block matrix over its free unknowns, supernodal, one thread. The symbolic part is made once.
class BlockFactor {
 public:
  /// held: 3 × nodes, true where the unknown is not free.
  BlockFactor(const BlockMatrix& A, const Eigen::Array<bool, 3, Eigen::Dynamic>& held);
  ~BlockFactor();
  BlockFactor(const BlockFactor&) = delete;
  BlockFactor& operator=(const BlockFactor&) = delete;

  /// False where A is not positive definite. Throws SolverFailed where memory runs out. A has the pattern given.
  bool factorise(const BlockMatrix& A);
  /// x = A⁻¹ b on the free unknowns, 0 at held ones. Precondition: factorise said true.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);
  int free() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Inverse diagonal blocks of A as a map x → D⁻¹ x, 0 at held unknowns.
class BlockJacobi {
 public:
  BlockJacobi(const BlockMatrix& A, const Eigen::Array<bool, 3, Eigen::Dynamic>& held);
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

 private:
  std::vector<Eigen::Matrix3d> inverse_;
};

}  // namespace glisson::mechanics
