// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/krylov.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 16384;

/// Sum of a[i] b[i] over [begin, end).
template <class T, class Z>
double partOfDot(const T* a, const Z* b, std::size_t begin, std::size_t end) {
  double s[4] = {0, 0, 0, 0};
  std::size_t i = begin;
  for (; i + 4 <= end; i += 4)
    for (std::size_t l = 0; l < 4; ++l) s[l] += static_cast<double>(a[i + l]) * static_cast<double>(b[i + l]);
  for (; i < end; ++i) s[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return (s[0] + s[1]) + (s[2] + s[3]);
}

/// rᵀ z, and qᵀ z where asked for; parts added in chunk order.
template <class T, class Z>
std::array<double, 2> sumsOf(const std::vector<T>& r, const std::vector<T>& q, const std::vector<Z>& z, bool both) {
  std::vector<std::array<double, 2>> parts((r.size() + chunk - 1) / chunk);
  parallelChunks(r.size(), chunk, [&](std::size_t begin, std::size_t end) {
    parts[begin / chunk] = {partOfDot(r.data(), z.data(), begin, end),
                            both ? partOfDot(q.data(), z.data(), begin, end) : 0.0};
  });
  std::array<double, 2> sum = {0, 0};
  for (const auto& part : parts)
    for (std::size_t s = 0; s < 2; ++s) sum[s] += part[s];
  return sum;
}

// Loops over plain pointers: the checked operator[] of vectors keeps them from the vector registers.

/// r = b − q.
template <class T>
void subtract(const std::vector<T>& b, const std::vector<T>& q, std::vector<T>& r) {
  parallelChunks(r.size(), chunk, [bs = b.data(), qs = q.data(), rs = r.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) rs[i] = bs[i] - qs[i];
  });
}

/// x += a p, r −= a q; returns rᵀ r.
template <class T>
double advance(T a, const std::vector<T>& p, const std::vector<T>& q, std::vector<T>& x, std::vector<T>& r) {
  return parallelSum(
      x.size(), chunk,
      [a, ps = p.data(), qs = q.data(), xs = x.data(), rs = r.data()](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          xs[i] += a * ps[i];
          rs[i] -= a * qs[i];
        }
        return partOfDot(rs, rs, begin, end);  // still in cache
      });
}

/// p = z + b p.
template <class T, class Z>
void turn(T b, const std::vector<Z>& z, std::vector<T>& p) {
  parallelChunks(p.size(), chunk, [b, zs = z.data(), ps = p.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ps[i] = zs[i] + b * ps[i];
  });
}

/// When to ask whether a solve is slow, and what its rate promises.
class Lookout {
 public:
  explicit Lookout(const KrylovOptions& options) : options_(options) {}
  bool due(int iterations) const { return options_.slow && iterations >= next_; }
  /// left: √ of the share of the residual or the energy that is left, whichever is larger.
  bool isSlow(int iterations, double left) {
    next_ = iterations + every;
    const double gained = std::log(left / mark_) / std::log(options_.tolerance / mark_);
    const double expected = from_ + (iterations - from_) / std::max(gained, 1e-3);
    if (!options_.slow(static_cast<int>(std::ceil(expected)))) return false;
    from_ = iterations;
    mark_ = left;
    next_ = iterations + first;
    return true;
  }

 private:
  static constexpr int first = 16, every = 8;
  const KrylovOptions& options_;
  int next_ = first, from_ = 0;
  double mark_ = 1;
};

}  // namespace

template <class T, class Z>
double dot(const std::vector<T>& a, const std::vector<Z>& b) {
  return parallelSum(a.size(), chunk,
                     [&](std::size_t begin, std::size_t end) { return partOfDot(a.data(), b.data(), begin, end); });
}

template <class T>
double norm(const std::vector<T>& a) {
  return std::sqrt(dot(a, a));
}

template <class T, class Z>
KrylovResult conjugateGradients(const LatticeOperator<T>& A, const std::vector<T>& b, std::vector<T>& x,
                                const std::type_identity_t<PreconditioningOf<T, Z>>& M, const KrylovOptions& options,
                                const Progress& progress) {
  const std::size_t n = b.size();
  KrylovResult result;
  std::vector<T> r = b;
  std::vector<Z> z(n);
  std::vector<T> p(n);
  std::vector<T> q(n);
  x.assign(n, T{0});
  const double bNorm = norm(b);
  const double goal = options.tolerance * bNorm;
  double rNorm = bNorm, rz = 0;
  const auto trueResidual = [&] {
    A.apply(x.data(), q.data());
    subtract(b, q, r);
    return norm(r);
  };
  const auto ended = [&](SolveStatus status) {
    result.status = status;
    // A solve that has converged has just recomputed it.
    if (status != SolveStatus::Converged && !options.recursive) rNorm = trueResidual();
    result.residual = rNorm / bNorm;
    if (!std::isfinite(result.residual)) result.status = SolveStatus::NotFinite;
    return result;
  };
  const auto startFromResidual = [&] {
    M(r, z);
    rz = dot(r, z);
    p.assign(z.begin(), z.end());
  };
  if (!std::isfinite(bNorm)) return ended(SolveStatus::NotFinite);
  startFromResidual();
  double rzOfB = rz;
  double lastRestart = bNorm;
  Lookout lookout(options);
  while (true) {
    progress.check();
    if (!std::isfinite(rNorm) || !std::isfinite(rz)) return ended(SolveStatus::NotFinite);
    if (rNorm <= goal && (!options.energyToo || rz <= options.tolerance * options.tolerance * rzOfB)) {
      if (!options.recursive) rNorm = trueResidual();
      if (rNorm <= goal) return ended(SolveStatus::Converged);
      // Rounding has parted the recursion from the truth: start again from x, unless that no longer helps.
      if (rNorm > 0.5 * lastRestart) return ended(SolveStatus::StoppedAtLimit);
      lastRestart = rNorm;
      startFromResidual();
    }
    if (lookout.due(result.iterations) &&
        lookout.isSlow(result.iterations, std::max(rNorm / bNorm, std::sqrt(rz / rzOfB)))) {
      M(b, z);
      rzOfB = dot(b, z);
      startFromResidual();
    }
    if (result.iterations >= options.limit) return ended(SolveStatus::StoppedAtLimit);
    A.apply(p.data(), q.data());
    const double pq = dot(p, q);
    if (!std::isfinite(pq)) return ended(SolveStatus::NotFinite);
    if (pq <= 0 || rz <= 0) return ended(SolveStatus::Indefinite);
    const double alpha = rz / pq;
    rNorm = std::sqrt(advance(static_cast<T>(alpha), p, q, x, r));
    ++result.iterations;
    M(r, z);
    const auto [rzNew, qz] = sumsOf(r, q, z, options.flexible);
    // Polak-Ribière: r_new − r_old = −α q.
    const double beta = options.flexible ? std::max(0.0, -alpha * qz / rz) : rzNew / rz;
    rz = rzNew;
    turn(static_cast<T>(beta), z, p);
    if (result.iterations % 5 == 0)
      progress.report(std::clamp(std::log(rNorm / bNorm) / std::log(options.tolerance), 0.0, 1.0), "solving");
  }
}

template double dot<float>(const std::vector<float>&, const std::vector<float>&);
template double dot<double>(const std::vector<double>&, const std::vector<double>&);
template double dot<double, float>(const std::vector<double>&, const std::vector<float>&);
template double norm<float>(const std::vector<float>&);
template double norm<double>(const std::vector<double>&);
template KrylovResult conjugateGradients<float>(const LatticeOperator<float>&, const std::vector<float>&,
                                                std::vector<float>&, const PreconditioningOf<float>&,
                                                const KrylovOptions&, const Progress&);
template KrylovResult conjugateGradients<double>(const LatticeOperator<double>&, const std::vector<double>&,
                                                 std::vector<double>&, const PreconditioningOf<double>&,
                                                 const KrylovOptions&, const Progress&);
template KrylovResult conjugateGradients<double, float>(const LatticeOperator<double>&, const std::vector<double>&,
                                                        std::vector<double>&, const PreconditioningOf<double, float>&,
                                                        const KrylovOptions&, const Progress&);

}  // namespace glisson::mechanics
