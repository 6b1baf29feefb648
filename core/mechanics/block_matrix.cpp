// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/block_matrix.h"

#include <cholmod.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

extern "C" void openblas_set_num_threads(int);

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
  cholmod_common common{};
  cholmod_sparse* K = nullptr;
  cholmod_factor* L = nullptr;
  cholmod_dense* X = nullptr;
  cholmod_dense* Y = nullptr;
  cholmod_dense* W = nullptr;
  std::vector<int> freeOf;     ///< free unknown per unknown, −1 where held
  std::vector<int> unknownOf;  ///< unknown per free unknown
  std::vector<double> right;

  State() { cholmod_l_start(&common); }
  ~State() {
    cholmod_l_free_sparse(&K, &common);
    cholmod_l_free_factor(&L, &common);
    cholmod_l_free_dense(&X, &common);
    cholmod_l_free_dense(&Y, &common);
    cholmod_l_free_dense(&W, &common);
    cholmod_l_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[noreturn]] void noMemory() const {
    throw SolverFailed("the factorisation of " + std::to_string(unknownOf.size()) +
                           " degrees of freedom ran out of memory; use larger cells or another solver",
                       0, 1.0, 0.0);
  }
};

BlockFactor::BlockFactor(const BlockMatrix& A, const Eigen::Array<bool, 3, Eigen::Dynamic>& held)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  openblas_set_num_threads(1);
  s.freeOf.assign(3 * static_cast<std::size_t>(A.nodes()), -1);
  for (int node = 0; node < A.nodes(); ++node)
    for (int c = 0; c < 3; ++c)
      if (!held(c, node)) {
        s.freeOf[static_cast<std::size_t>(3 * node + c)] = static_cast<int>(s.unknownOf.size());
        s.unknownOf.push_back(3 * node + c);
      }
  if (s.unknownOf.empty()) return;
  s.right.resize(s.unknownOf.size());
  std::size_t entries = 0;
  for (int node = 0; node < A.nodes(); ++node)
    for (std::size_t p = A.rowStart_[static_cast<std::size_t>(node)];
         p < A.rowStart_[static_cast<std::size_t>(node) + 1]; ++p)
      if (A.column_[p] >= node) entries += 9;
  const std::size_t n = s.unknownOf.size();
  s.common.supernodal = CHOLMOD_SUPERNODAL;
  s.common.final_ll = 1;
  s.common.print = 0;
  s.common.quick_return_if_not_posdef = 1;
  s.K = cholmod_l_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_REAL, &s.common);
  if (s.K == nullptr) s.noMemory();
  auto* start = static_cast<SuiteSparse_long*>(s.K->p);
  auto* row = static_cast<SuiteSparse_long*>(s.K->i);
  SuiteSparse_long count = 0;
  for (std::size_t j = 0; j < n; ++j) {
    start[j] = count;
    const auto node = static_cast<std::size_t>(s.unknownOf[j] / 3);
    for (std::size_t p = A.rowStart_[node]; p < A.rowStart_[node + 1]; ++p)
      for (int c = 0; c < 3; ++c) {
        const int i = s.freeOf[static_cast<std::size_t>(3 * A.column_[p] + c)];
        if (i >= static_cast<int>(j)) row[count++] = i;
      }
  }
  start[n] = count;
  s.L = cholmod_l_analyze(s.K, &s.common);
  if (s.L == nullptr) s.noMemory();
}

BlockFactor::~BlockFactor() = default;

int BlockFactor::free() const {
  return static_cast<int>(state_->unknownOf.size());
}

bool BlockFactor::factorise(const BlockMatrix& A) {
  State& s = *state_;
  if (s.unknownOf.empty()) return true;
  auto* value = static_cast<double*>(s.K->x);
  for (std::size_t j = 0; j < s.unknownOf.size(); ++j) {
    const auto node = static_cast<std::size_t>(s.unknownOf[j] / 3);
    const int axis = s.unknownOf[j] % 3;
    for (std::size_t p = A.rowStart_[node]; p < A.rowStart_[node + 1]; ++p)
      for (int c = 0; c < 3; ++c)
        if (s.freeOf[static_cast<std::size_t>(3 * A.column_[p] + c)] >= static_cast<int>(j))
          *value++ = A.value_[p](axis, c);
  }
  s.common.status = CHOLMOD_OK;
  cholmod_l_factorize(s.K, s.L, &s.common);
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY || s.common.status == CHOLMOD_TOO_LARGE) s.noMemory();
  return s.common.status == CHOLMOD_OK && s.L->minor == s.L->n;
}

void BlockFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  State& s = *state_;
  x.setZero(b.size());
  if (s.unknownOf.empty()) return;
  for (std::size_t i = 0; i < s.right.size(); ++i) s.right[i] = b[s.unknownOf[i]];
  cholmod_dense B{};
  B.nrow = B.nzmax = B.d = s.right.size();
  B.ncol = 1;
  B.x = s.right.data();
  B.xtype = CHOLMOD_REAL;
  B.dtype = CHOLMOD_DOUBLE;
  if (cholmod_l_solve2(CHOLMOD_A, s.L, &B, nullptr, &s.X, nullptr, &s.Y, &s.W, &s.common) == 0) s.noMemory();
  const auto* result = static_cast<const double*>(s.X->x);
  for (std::size_t i = 0; i < s.right.size(); ++i) x[s.unknownOf[i]] = result[i];
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
