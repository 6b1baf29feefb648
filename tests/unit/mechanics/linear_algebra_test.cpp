// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "mechanics/detail/one_blas_thread.h"
#include "mechanics/detail/sparse_cholesky.h"
#include "mechanics/krylov.h"

extern "C" {
int openblas_get_num_threads();
void openblas_set_num_threads(int threads);
}

using namespace glisson;
using namespace glisson::mechanics;

namespace {

/// −Δ on a line of n points, plus a diagonal: eigenvalues shift + 2 − 2 cos(π k / (n + 1)).
LowerTriangle line(Eigen::Index n, double shift) {
  std::vector<Eigen::Triplet<double, std::int64_t>> entries;
  for (Eigen::Index i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2 + shift);
    if (i > 0) entries.emplace_back(i, i - 1, -1);
  }
  LowerTriangle A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Eigen::VectorXd times(const LowerTriangle& A, const Eigen::VectorXd& x) {
  return A.selfadjointView<Eigen::Lower>() * x;
}

KrylovResult solve(const LowerTriangle& A, const Eigen::VectorXd& b, Eigen::VectorXd& x, const KrylovOptions& options) {
  return conjugateGradients([&](const Eigen::VectorXd& p, Eigen::VectorXd& q) { q = times(A, p); }, {}, b, x, options,
                            {});
}

}  // namespace

TEST(SparseCholesky, SolvesAndTakesNewValuesOfItsPattern) {
  const Eigen::Index n = 500;
  SparseCholesky cholesky(line(n, 0.1));
  for (const double shift : {0.1, 3.0}) {
    const LowerTriangle A = line(n, shift);
    ASSERT_TRUE(cholesky.factorise(A));
    const Eigen::VectorXd wanted = Eigen::VectorXd::LinSpaced(n, -1, 2);
    Eigen::VectorXd x = times(A, wanted);
    cholesky.solve(x.data(), x.data());
    EXPECT_LT((x - wanted).norm(), 1e-12 * wanted.norm());
  }
}

TEST(SparseCholesky, SaysWhereAMatrixIsNotPositiveDefinite) {
  SparseCholesky cholesky(line(50, 0));
  EXPECT_TRUE(cholesky.factorise(line(50, 0)));      // least eigenvalue 4e-3
  EXPECT_FALSE(cholesky.factorise(line(50, -0.1)));  // below 0
}

TEST(SparseCholesky, NoUnknownsNeedNoMemory) {
  SparseCholesky cholesky(LowerTriangle(0, 0));
  EXPECT_TRUE(cholesky.factorise(LowerTriangle(0, 0)));
  cholesky.solve(nullptr, nullptr);
  EXPECT_EQ(cholesky.bytes(), 0);
}

TEST(OneBlasThread, TheLastOneGivesTheNumberBack) {
  openblas_set_num_threads(2);
  const int before = openblas_get_num_threads();  // 1 where BLAS has no threads
  {
    const OneBlasThread outer;
    EXPECT_EQ(openblas_get_num_threads(), 1);
    std::thread([] {
      const OneBlasThread inner;
      EXPECT_EQ(openblas_get_num_threads(), 1);
    }).join();
    EXPECT_EQ(openblas_get_num_threads(), 1);
  }
  EXPECT_EQ(openblas_get_num_threads(), before);
}

// In exact arithmetic conjugate gradients end after as many steps as A has different eigenvalues.
TEST(ConjugateGradients, EndAfterAsManyStepsAsEigenvalues) {
  const Eigen::Index n = 12;
  KrylovOptions options;
  options.tolerance = 1e-10;
  Eigen::VectorXd x;
  const KrylovResult result = solve(line(n, 0.5), Eigen::VectorXd::LinSpaced(n, 1, 2), x, options);
  EXPECT_EQ(result.status, SolveStatus::Converged);
  EXPECT_LE(result.iterations, n);
  EXPECT_LE(result.residual, options.tolerance);
}

TEST(ConjugateGradients, AWarmStartFromTheAnswerTakesNoStep) {
  const LowerTriangle A = line(40, 0.2);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1, 3);
  KrylovOptions options;
  Eigen::VectorXd x;
  ASSERT_EQ(solve(A, b, x, options).status, SolveStatus::Converged);
  options.warm = true;
  EXPECT_EQ(solve(A, b, x, options).iterations, 0);
  options.warm = false;
  EXPECT_GT(solve(A, b, x, options).iterations, 0);
}

TEST(ConjugateGradients, NoLoadGivesNoDisplacement) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(9);
  KrylovOptions options;
  options.warm = true;
  const KrylovResult result = solve(line(9, 1), Eigen::VectorXd::Zero(9), x, options);
  EXPECT_EQ(result.status, SolveStatus::Converged);
  EXPECT_EQ(x.norm(), 0);
}

TEST(ConjugateGradients, SayWhatIsIndefiniteOrNotFinite) {
  Eigen::VectorXd x;
  EXPECT_EQ(solve(line(30, -3), Eigen::VectorXd::Ones(30), x, {}).status, SolveStatus::Indefinite);
  Eigen::VectorXd b = Eigen::VectorXd::Ones(30);
  b[4] = std::nan("");
  EXPECT_EQ(solve(line(30, 1), b, x, {}).status, SolveStatus::NotFinite);
}
