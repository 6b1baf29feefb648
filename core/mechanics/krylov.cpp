#include "mechanics/krylov.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 16384;

/// Calls f(i) for all i < n.
template <class F>
void forAll(std::size_t n, const F& f) {
  parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(i);
  });
}

}  // namespace

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return parallelSum(a.size(), chunk, [&](std::size_t begin, std::size_t end) {
    double s[4] = {0, 0, 0, 0};
    std::size_t i = begin;
    for (; i + 4 <= end; i += 4)
      for (std::size_t l = 0; l < 4; ++l) s[l] += a[i + l] * b[i + l];
    for (; i < end; ++i) s[0] += a[i] * b[i];
    return (s[0] + s[1]) + (s[2] + s[3]);
  });
}

double norm(const std::vector<double>& a) {
  return std::sqrt(dot(a, a));
}

KrylovResult conjugateGradients(const LatticeOperator<double>& A, const std::vector<double>& b, std::vector<double>& x,
                                const Preconditioning& M, const KrylovOptions& options, const Progress& progress) {
  const std::size_t n = b.size();
  KrylovResult result;
  std::vector<double> r = b;
  std::vector<double> z(n);
  std::vector<double> p(n);
  std::vector<double> q(n);
  x.assign(n, 0.0);
  const double bNorm = norm(b);
  const double goal = options.tolerance * bNorm;
  const auto trueResidual = [&] {
    A.apply(x.data(), q.data());
    forAll(n, [&](std::size_t i) { r[i] = b[i] - q[i]; });
    return norm(r);
  };
  const auto ended = [&](SolveStatus status) {
    result.status = status;
    result.residual = trueResidual() / bNorm;
    if (!std::isfinite(result.residual)) result.status = SolveStatus::NotFinite;
    return result;
  };
  if (!std::isfinite(bNorm)) return ended(SolveStatus::NotFinite);
  M(r, z);
  double rz = dot(r, z);
  const double rzGoal = options.tolerance * options.tolerance * rz;
  double rNorm = bNorm;
  double lastRestart = bNorm;
  p = z;
  while (true) {
    progress.check();
    if (!std::isfinite(rNorm) || !std::isfinite(rz)) return ended(SolveStatus::NotFinite);
    if (rNorm <= goal && (!options.energyToo || rz <= rzGoal)) {
      rNorm = trueResidual();
      if (rNorm <= goal) return ended(SolveStatus::Converged);
      // Rounding has parted the recursion from the truth: start again from x, unless that no longer helps.
      if (rNorm > 0.5 * lastRestart) return ended(SolveStatus::StoppedAtLimit);
      lastRestart = rNorm;
      M(r, z);
      rz = dot(r, z);
      p = z;
    }
    if (result.iterations >= options.limit) return ended(SolveStatus::StoppedAtLimit);
    A.apply(p.data(), q.data());
    const double pq = dot(p, q);
    if (!std::isfinite(pq)) return ended(SolveStatus::NotFinite);
    if (pq <= 0 || rz <= 0) return ended(SolveStatus::Indefinite);
    const double alpha = rz / pq;
    forAll(n, [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    });
    ++result.iterations;
    rNorm = norm(r);
    M(r, z);
    // Polak-Ribière: r_new − r_old = −α q.
    const double rzNew = dot(r, z);
    const double beta = (options.flexible ? -alpha * dot(q, z) : rzNew) / rz;
    const double b1 = options.flexible ? std::max(0.0, beta) : beta;
    rz = rzNew;
    forAll(n, [&](std::size_t i) { p[i] = z[i] + b1 * p[i]; });
    if (result.iterations % 5 == 0)
      progress.report(std::clamp(std::log(rNorm / bNorm) / std::log(options.tolerance), 0.0, 1.0), "solving");
  }
}

}  // namespace glisson::mechanics
