// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/block_matrix.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "mechanics/detail/sparse_cholesky.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t rowChunk = 2048;

}  // namespace

BlockMatrix::BlockMatrix(int nodes, const Eigen::MatrixXi& elements) {
  const auto n = static_cast<std::size_t>(nodes);
  std::vector<std::size_t> start(n + 1, 0);
  for (const int node : elements.reshaped()) ++start[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 0; i < n; ++i) start[i + 1] += start[i];
  std::vector<int> elementOf(start[n]);
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (Eigen::Index e = 0; e < elements.cols(); ++e)
    for (const int node : elements.col(e)) elementOf[next[static_cast<std::size_t>(node)]++] = static_cast<int>(e);
  rowStart_.assign(n + 1, 0);
  std::vector<int> row;
  for (std::size_t i = 0; i < n; ++i) {
    row.assign(1, static_cast<int>(i));
    for (std::size_t p = start[i]; p < start[i + 1]; ++p)
      for (const int node : elements.col(elementOf[p])) row.push_back(node);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    column_.insert(column_.end(), row.begin(), row.end());
    rowStart_[i + 1] = column_.size();
  }
  value_.assign(column_.size(), Eigen::Matrix3d::Zero());
}

void BlockMatrix::setZero() {
  std::fill(value_.begin(), value_.end(), Eigen::Matrix3d::Zero());
}

std::size_t BlockMatrix::find(int row, int column) const {
  const auto begin = column_.begin() + static_cast<std::ptrdiff_t>(rowStart_[static_cast<std::size_t>(row)]);
  const auto end = column_.begin() + static_cast<std::ptrdiff_t>(rowStart_[static_cast<std::size_t>(row) + 1]);
  return static_cast<std::size_t>(std::lower_bound(begin, end, column) - column_.begin());
}

void BlockMatrix::add(const int* nodes, const Eigen::Ref<const Eigen::MatrixXd>& Ke) {
  const Eigen::Index m = Ke.rows() / 3;
  for (Eigen::Index a = 0; a < m; ++a)
    for (Eigen::Index b = 0; b < m; ++b) value_[find(nodes[a], nodes[b])] += Ke.block<3, 3>(3 * a, 3 * b);
}

void BlockMatrix::addDiagonal(int node, const Eigen::Matrix3d& k) {
  value_[find(node, node)] += k;
}

Eigen::Matrix3d BlockMatrix::diagonalBlock(int node) const {
  return value_[find(node, node)];
}

void BlockMatrix::apply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.resize(x.size());
  parallelChunks(static_cast<std::size_t>(nodes()), rowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t p = rowStart_[i]; p < rowStart_[i + 1]; ++p)
        sum.noalias() += value_[p] * x.segment<3>(3 * column_[p]);
      y.segment<3>(3 * static_cast<Eigen::Index>(i)) = sum;
    }
  });
}

struct BlockFactor::State {
  LowerTriangle K;
  std::vector<int> freeOf;     ///< free unknown per unknown, −1 where held
  std::vector<int> unknownOf;  ///< unknown per free unknown
  std::vector<double> right;
  std::optional<SparseCholesky> cholesky;
};

BlockFactor::BlockFactor(const BlockMatrix& A, const Eigen::Array<bool, 3, Eigen::Dynamic>& held)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.freeOf.assign(3 * static_cast<std::size_t>(A.nodes()), -1);
  for (int node = 0; node < A.nodes(); ++node)
    for (int c = 0; c < 3; ++c)
      if (!held(c, node)) {
        s.freeOf[static_cast<std::size_t>(3 * node + c)] = static_cast<int>(s.unknownOf.size());
        s.unknownOf.push_back(3 * node + c);
      }
  s.right.resize(s.unknownOf.size());
  std::size_t entries = 0;
  for (int node = 0; node < A.nodes(); ++node)
    for (std::size_t p = A.rowStart_[static_cast<std::size_t>(node)];
         p < A.rowStart_[static_cast<std::size_t>(node) + 1]; ++p)
      if (A.column_[p] >= node) entries += 9;
  const std::size_t n = s.unknownOf.size();
  s.K.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  s.K.resizeNonZeros(static_cast<Eigen::Index>(entries));
  std::int64_t count = 0;
  for (std::size_t j = 0; j < n; ++j) {
    s.K.outerIndexPtr()[j] = count;
    const auto node = static_cast<std::size_t>(s.unknownOf[j] / 3);
    for (std::size_t p = A.rowStart_[node]; p < A.rowStart_[node + 1]; ++p)
      for (int c = 0; c < 3; ++c) {
        const int i = s.freeOf[static_cast<std::size_t>(3 * A.column_[p] + c)];
        if (i >= static_cast<int>(j)) s.K.innerIndexPtr()[count++] = i;
      }
  }
  s.K.outerIndexPtr()[n] = count;
  s.K.resizeNonZeros(count);
  s.cholesky.emplace(s.K);
}

BlockFactor::~BlockFactor() = default;

int BlockFactor::free() const {
  return static_cast<int>(state_->unknownOf.size());
}

bool BlockFactor::factorise(const BlockMatrix& A) {
  State& s = *state_;
  double* value = s.K.valuePtr();
  for (std::size_t j = 0; j < s.unknownOf.size(); ++j) {
    const auto node = static_cast<std::size_t>(s.unknownOf[j] / 3);
    const int axis = s.unknownOf[j] % 3;
    for (std::size_t p = A.rowStart_[node]; p < A.rowStart_[node + 1]; ++p)
      for (int c = 0; c < 3; ++c)
        if (s.freeOf[static_cast<std::size_t>(3 * A.column_[p] + c)] >= static_cast<int>(j))
          *value++ = A.value_[p](axis, c);
  }
  return s.cholesky->factorise(s.K);
}

void BlockFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  State& s = *state_;
  x.setZero(b.size());
  for (std::size_t i = 0; i < s.right.size(); ++i) s.right[i] = b[s.unknownOf[i]];
  s.cholesky->solve(s.right.data(), s.right.data());
  for (std::size_t i = 0; i < s.right.size(); ++i) x[s.unknownOf[i]] = s.right[i];
}

BlockJacobi::BlockJacobi(const BlockMatrix& A, const Eigen::Array<bool, 3, Eigen::Dynamic>& held)
    : inverse_(static_cast<std::size_t>(A.nodes())) {
  for (int node = 0; node < A.nodes(); ++node) {
    Eigen::Matrix3d B = A.diagonalBlock(node);
    for (int c = 0; c < 3; ++c)
      if (held(c, node)) {
        B.row(c).setZero();
        B.col(c).setZero();
        B(c, c) = 1;
      }
    B = B.inverse().eval();
    for (int c = 0; c < 3; ++c)
      if (held(c, node)) B(c, c) = 0;
    inverse_[static_cast<std::size_t>(node)] = B;
  }
}

void BlockJacobi::apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
  z.resize(r.size());
  parallelChunks(inverse_.size(), rowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const auto at = 3 * static_cast<Eigen::Index>(node);
      z.segment<3>(at) = inverse_[node] * r.segment<3>(at);
    }
  });
}

}  // namespace glisson::mechanics
