// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/spectral_bound.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 32768;
constexpr double shortfall = 0.13;  ///< ε
constexpr double risk = 1e-4;       ///< that the Ritz value falls short by more

int stepsFor(double unknowns) {
  return static_cast<int>(std::ceil(0.5 * (1 + std::log(1.648 * std::sqrt(unknowns) / risk) / std::sqrt(shortfall))));
}

/// Sum of f(i) for i < n in fixed chunks.
template <class F>
double sumOf(std::size_t n, const F& f) {
  return parallelSum(n, chunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += f(i);
    return sum;
  });
}

/// Calls f(i) for all i < n.
template <class F>
void forAll(std::size_t n, const F& f) {
  parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(i);
  });
}

}  // namespace

double boundOverCells(const HexMatrix& K0, bool withMass) {
  const Eigen::VectorXd scale = K0.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * K0 * scale.asDiagonal(),
                                                             Eigen::EigenvaluesOnly);
  // Rounding of the eigenvalue, and of the float operator that the bound is used for.
  return std::max(withMass ? 3.375 : 3.0, (1 + 1e-5) * eigen.eigenvalues()[23]);
}

double boundByIteration(const LatticeOperator<float>& A, const std::vector<float>& inverseDiagonal,
                        std::vector<float>& work1, std::vector<float>& work2, std::vector<float>& work3) {
  // D^{-1/2} A D^{-1/2} in the variables of D⁻¹ A, where the inner product is that of D: v the present vector, w the
  // last one and then the next, y = A v.
  const std::size_t n = A.size();
  std::vector<float>& v = work1;
  std::vector<float>& w = work2;
  std::vector<float>& y = work3;
  const float* inverse = inverseDiagonal.data();
  const double unknowns = sumOf(n, [&](std::size_t i) { return inverse[i] > 0 ? 1.0 : 0.0; });
  if (unknowns == 0) return std::numeric_limits<double>::infinity();
  Random random(17);
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double start = inverse[i] > 0 ? random.uniform(-1, 1) : 0.0;
    square += start * start;
    v[i] = static_cast<float>(start) * std::sqrt(inverse[i]);
    w[i] = 0;
  }
  std::vector<double> diagonal, beside;
  double length = std::sqrt(square);
  const int steps = static_cast<int>(std::min<double>(unknowns, stepsFor(unknowns)));
  for (int step = 0; step < steps; ++step) {
    const auto shrink = static_cast<float>(1 / length);
    forAll(n, [&](std::size_t i) { v[i] *= shrink; });
    A.apply(v.data(), y.data());
    const double alpha = sumOf(n, [&](std::size_t i) { return static_cast<double>(v[i]) * y[i]; });
    const auto a = static_cast<float>(alpha);
    const auto b = static_cast<float>(step == 0 ? 0.0 : beside.back());
    length = std::sqrt(sumOf(n, [&](std::size_t i) {
      w[i] = inverse[i] * y[i] - a * v[i] - b * w[i];
      return inverse[i] > 0 ? static_cast<double>(w[i]) * w[i] / inverse[i] : 0.0;
    }));
    diagonal.push_back(alpha);
    beside.push_back(length);
    std::swap(v, w);
    if (!(length > 1e-6 * diagonal.front())) break;  // the Ritz values are eigenvalues
  }
  const auto count = static_cast<Eigen::Index>(diagonal.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    T(i, i) = diagonal[static_cast<std::size_t>(i)];
    if (i + 1 < count) T(i, i + 1) = T(i + 1, i) = beside[static_cast<std::size_t>(i)];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(T, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[count - 1] / (1 - shortfall);
}

}  // namespace glisson::mechanics
