// SPDX-License-Identifier: GPL-3.0-or-later
#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "mechanics/detail/one_blas_thread.h"
#include "mechanics/detail/sparse_cholesky.h"

namespace glisson::mechanics {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

/// CHOLMOD's view of A; nothing is copied, and CHOLMOD writes nothing into it.
cholmod_sparse viewOf(const LowerTriangle& A) {
  cholmod_sparse view{};
  view.nrow = static_cast<std::size_t>(A.rows());
  view.ncol = static_cast<std::size_t>(A.cols());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<std::int64_t*>(A.outerIndexPtr());
  view.i = const_cast<std::int64_t*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace

struct SparseCholesky::State {
  Eigen::Index rows = 0;
  cholmod_common common{};
  cholmod_factor* L = nullptr;
  cholmod_dense* X = nullptr;
  cholmod_dense* Y = nullptr;
  cholmod_dense* W = nullptr;

  State() {
    cholmod_l_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
  }
  ~State() {
    cholmod_l_free_dense(&X, &common);
    cholmod_l_free_dense(&Y, &common);
    cholmod_l_free_dense(&W, &common);
    cholmod_l_free_factor(&L, &common);
    cholmod_l_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[noreturn]] void noMemory() const {
    const auto expected_MB = static_cast<long>(expectedBytes(static_cast<double>(rows)) / 1e6);
    throw SolverFailed("the factorisation of " + std::to_string(rows) +
                           " degrees of freedom ran out of memory (about " + std::to_string(expected_MB) +
                           " MB expected); use an iterative solver (multigrid or cg), or larger cells",
                       0, 1.0, 0.0);
  }
};

SparseCholesky::SparseCholesky(const LowerTriangle& A) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.rows = A.rows();
  if (s.rows == 0) return;
  const OneBlasThread one;
  cholmod_sparse view = viewOf(A);
  s.L = cholmod_l_analyze(&view, &s.common);
  if (s.L == nullptr) s.noMemory();
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factorise(const LowerTriangle& A) {
  State& s = *state_;
  if (s.rows == 0) return true;
  const OneBlasThread one;
  cholmod_sparse view = viewOf(A);
  s.common.status = CHOLMOD_OK;
  cholmod_l_factorize(&view, s.L, &s.common);
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY || s.common.status == CHOLMOD_TOO_LARGE) s.noMemory();
  return s.common.status == CHOLMOD_OK && s.L->minor == s.L->n;
}

void SparseCholesky::solve(const double* b, double* x) {
  State& s = *state_;
  if (s.rows == 0) return;
  const OneBlasThread one;
  cholmod_dense B{};
  B.nrow = B.nzmax = B.d = static_cast<std::size_t>(s.rows);
  B.ncol = 1;
  B.x = const_cast<double*>(b);
  B.xtype = CHOLMOD_REAL;
  B.dtype = CHOLMOD_DOUBLE;
  if (cholmod_l_solve2(CHOLMOD_A, s.L, &B, nullptr, &s.X, nullptr, &s.Y, &s.W, &s.common) == 0) s.noMemory();
  const auto* result = static_cast<const double*>(s.X->x);
  std::copy(result, result + s.rows, x);
}

Eigen::Index SparseCholesky::rows() const {
  return state_->rows;
}

double SparseCholesky::bytes() const {
  return state_->L == nullptr ? 0 : 8 * static_cast<double>(state_->L->xsize);
}

double SparseCholesky::expectedBytes(double dofs) {
  return 8 * 14.0 * std::pow(dofs, 4.0 / 3.0);
}

}  // namespace glisson::mechanics
