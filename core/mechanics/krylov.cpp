// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/krylov.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 16384;

/// Number of an array of numbers, a std::vector or an Eigen::VectorXd.
template <class V>
using ValueOf = std::remove_cvref_t<decltype(*std::declval<V&>().data())>;

template <class V>
std::size_t sizeOf(const V& v) {
  return static_cast<std::size_t>(v.size());
}

template <class V>
V arrayOf(std::size_t n) {
  if constexpr (std::is_same_v<V, Eigen::VectorXd>)
    return V(static_cast<Eigen::Index>(n));
  else
    return V(n);
}

/// Sum of a[i] b[i] over [begin, end).
template <class V, class W>
double partOfDot(const V& a, const W& b, std::size_t begin, std::size_t end) {
  if constexpr (std::is_same_v<V, Eigen::VectorXd>) {
    const auto from = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    return a.segment(from, count).dot(b.segment(from, count));
  } else {
    const auto* as = a.data();
    const auto* bs = b.data();
    double s[4] = {0, 0, 0, 0};
    std::size_t i = begin;
    for (; i + 4 <= end; i += 4)
      for (std::size_t l = 0; l < 4; ++l) s[l] += static_cast<double>(as[i + l]) * static_cast<double>(bs[i + l]);
    for (; i < end; ++i) s[0] += static_cast<double>(as[i]) * static_cast<double>(bs[i]);
    return (s[0] + s[1]) + (s[2] + s[3]);
  }
}

template <class V, class W>
double dotOf(const V& a, const W& b) {
  return parallelSum(sizeOf(a), chunk, [&](std::size_t begin, std::size_t end) { return partOfDot(a, b, begin, end); });
}

/// rᵀ z, and qᵀ z where asked for; parts added in chunk order.
template <class V, class W>
std::array<double, 2> sumsOf(const V& r, const V& q, const W& z, bool both) {
  std::vector<std::array<double, 2>> parts((sizeOf(r) + chunk - 1) / chunk);
  parallelChunks(sizeOf(r), chunk, [&](std::size_t begin, std::size_t end) {
    parts[begin / chunk] = {partOfDot(r, z, begin, end), both ? partOfDot(q, z, begin, end) : 0.0};
  });
  std::array<double, 2> sum = {0, 0};
  for (const auto& part : parts)
    for (std::size_t s = 0; s < 2; ++s) sum[s] += part[s];
  return sum;
}

// Loops over plain pointers: the checked operator[] of vectors keeps them from the vector registers.

/// r = b − q.
template <class V>
void subtract(const V& b, const V& q, V& r) {
  parallelChunks(sizeOf(r), chunk, [bs = b.data(), qs = q.data(), rs = r.data()](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) rs[i] = bs[i] - qs[i];
  });
}

/// x += a p, r −= a q; returns rᵀ r.
template <class V>
double advance(ValueOf<V> a, const V& p, const V& q, V& x, V& r) {
  return parallelSum(
      sizeOf(x), chunk,
      [a, ps = p.data(), qs = q.data(), xs = x.data(), rs = r.data(), &r](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          xs[i] += a * ps[i];
          rs[i] -= a * qs[i];
        }
        return partOfDot(r, r, begin, end);  // still in cache
      });
}

/// p = z + b p.
template <class V, class W>
void turn(ValueOf<V> b, const W& z, V& p) {
  parallelChunks(sizeOf(p), chunk, [b, zs = z.data(), ps = p.data()](std::size_t begin, std::size_t end) {
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

/// One solve. V: arrays of the unknowns, W: of the preconditioned residual; A(p, q) sets q = A p.
template <class V, class W, class Operator, class M>
class ConjugateGradients {
 public:
  ConjugateGradients(const Operator& A, const M& preconditioner, const V& b, V& x, const KrylovOptions& options)
      : A_(A),
        M_(preconditioner),
        b_(b),
        x_(x),
        options_(options),
        r_(b),
        z_(arrayOf<W>(sizeOf(b))),
        p_(arrayOf<V>(sizeOf(b))),
        q_(arrayOf<V>(sizeOf(b))),
        bNorm_(std::sqrt(dotOf(b, b))) {}

  KrylovResult run(const Progress& progress);

 private:
  double trueResidual() {
    A_(x_, q_);
    subtract(b_, q_, r_);
    return std::sqrt(dotOf(r_, r_));
  }
  KrylovResult ended(SolveStatus status) {
    result_.status = status;
    // A solve that has converged has just recomputed it.
    if (status != SolveStatus::Converged && !options_.recursive) rNorm_ = trueResidual();
    result_.residual = rNorm_ / bNorm_;
    if (!std::isfinite(result_.residual)) result_.status = SolveStatus::NotFinite;
    return result_;
  }
  void startFromResidual() {
    M_(r_, z_);
    rz_ = dotOf(r_, z_);
    std::copy(z_.data(), z_.data() + sizeOf(z_), p_.data());
  }
  bool small() const {
    return rNorm_ <= goal() && (!options_.energyToo || rz_ <= options_.tolerance * options_.tolerance * rzOfB_);
  }
  double goal() const { return options_.tolerance * bNorm_; }
  /// One step along p; the status that ends the solve, where it does.
  std::optional<SolveStatus> step();

  const Operator& A_;
  const M& M_;
  const V& b_;
  V& x_;
  const KrylovOptions& options_;
  V r_;
  W z_;
  V p_, q_;
  double bNorm_ = 0, rNorm_ = 0, rz_ = 0, rzOfB_ = 0;
  KrylovResult result_;
};

template <class V, class W, class Operator, class M>
std::optional<SolveStatus> ConjugateGradients<V, W, Operator, M>::step() {
  A_(p_, q_);
  const double pq = dotOf(p_, q_);
  if (!std::isfinite(pq)) return SolveStatus::NotFinite;
  if (pq <= 0 || rz_ <= 0) return SolveStatus::Indefinite;
  const double alpha = rz_ / pq;
  rNorm_ = std::sqrt(advance(static_cast<ValueOf<V>>(alpha), p_, q_, x_, r_));
  ++result_.iterations;
  M_(r_, z_);
  const auto [rzNew, qz] = sumsOf(r_, q_, z_, options_.flexible);
  // Polak-Ribière: r_new − r_old = −α q.
  const double beta = options_.flexible ? std::max(0.0, -alpha * qz / rz_) : rzNew / rz_;
  rz_ = rzNew;
  turn(static_cast<ValueOf<V>>(beta), z_, p_);
  return std::nullopt;
}

template <class V, class W, class Operator, class M>
KrylovResult ConjugateGradients<V, W, Operator, M>::run(const Progress& progress) {
  if (!options_.warm || sizeOf(x_) != sizeOf(b_)) {
    x_ = arrayOf<V>(sizeOf(b_));
    std::fill(x_.data(), x_.data() + sizeOf(x_), ValueOf<V>{0});
  }
  if (!std::isfinite(bNorm_)) return ended(SolveStatus::NotFinite);
  if (bNorm_ == 0) {
    std::fill(x_.data(), x_.data() + sizeOf(x_), ValueOf<V>{0});
    result_.status = SolveStatus::Converged;
    return result_;
  }
  rNorm_ = options_.warm ? trueResidual() : bNorm_;
  startFromResidual();
  rzOfB_ = rz_;
  double lastRestart = bNorm_;
  Lookout lookout(options_);
  while (true) {
    progress.check();
    if (!std::isfinite(rNorm_) || !std::isfinite(rz_)) return ended(SolveStatus::NotFinite);
    if (small()) {
      if (!options_.recursive) rNorm_ = trueResidual();
      if (rNorm_ <= goal()) return ended(SolveStatus::Converged);
      // The recursive residual has drifted from the true one: start again from x, unless that no longer helps.
      if (rNorm_ > 0.5 * lastRestart) return ended(SolveStatus::StoppedAtLimit);
      lastRestart = rNorm_;
      startFromResidual();
    }
    if (lookout.due(result_.iterations) &&
        lookout.isSlow(result_.iterations, std::max(rNorm_ / bNorm_, std::sqrt(rz_ / rzOfB_)))) {
      M_(b_, z_);
      rzOfB_ = dotOf(b_, z_);
      startFromResidual();
    }
    if (result_.iterations >= options_.limit) return ended(SolveStatus::StoppedAtLimit);
    if (const std::optional<SolveStatus> end = step()) return ended(*end);
    if (!options_.quiet && result_.iterations % 5 == 0)
      progress.report(std::clamp(std::log(rNorm_ / bNorm_) / std::log(options_.tolerance), 0.0, 1.0), "solving");
  }
}

}  // namespace

template <class T, class Z>
double dot(const std::vector<T>& a, const std::vector<Z>& b) {
  return dotOf(a, b);
}

template <class T>
double norm(const std::vector<T>& a) {
  return std::sqrt(dotOf(a, a));
}

template <class T, class Z>
KrylovResult conjugateGradients(const LatticeOperator<T>& A, const std::vector<T>& b, std::vector<T>& x,
                                const std::type_identity_t<PreconditioningOf<T, Z>>& M, const KrylovOptions& options,
                                const Progress& progress) {
  const auto apply = [&A](const std::vector<T>& p, std::vector<T>& q) { A.apply(p.data(), q.data()); };
  return ConjugateGradients<std::vector<T>, std::vector<Z>, decltype(apply), PreconditioningOf<T, Z>>(apply, M, b, x,
                                                                                                      options)
      .run(progress);
}

KrylovResult conjugateGradients(const VectorMap& A, const VectorMap& M, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                const KrylovOptions& options, const Progress& progress) {
  const VectorMap identity = [](const Eigen::VectorXd& r, Eigen::VectorXd& z) { z = r; };
  return ConjugateGradients<Eigen::VectorXd, Eigen::VectorXd, VectorMap, VectorMap>(A, M ? M : identity, b, x, options)
      .run(progress);
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
