// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/cell_kernel.h"

#include <cmath>

#include "mechanics/contact/cell_lanes.h"

namespace glisson::mechanics {
namespace {

/// p − p(rest), λ″ and the volume part of the energy for J − 1 = j, all for the given Lamé constants.
template <SolidLaw law, int Bytes>
GLISSON_INLINE void volumeLaw(const Lanes<double, Bytes>& j, const Lanes<double, Bytes>& mu,
                              const Lanes<double, Bytes>& lambda, Lanes<double, Bytes>& rise,
                              Lanes<double, Bytes>& second, Lanes<double, Bytes>& energy) {
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(double);
  if constexpr (law == SolidLaw::Logarithmic) {
    Lanes<double, Bytes> log = {};
    for (std::size_t l = 0; l < lanes; ++l) log[l] = std::log1p(j[l]);
    const Lanes<double, Bytes> inverse = 1.0 / (1.0 + j);
    rise = (mu * j + lambda * log) * inverse;
    second = (mu + lambda * (1.0 - log)) * inverse * inverse;
    energy = mu * (j - log) + 0.5 * lambda * log * log;
  } else {
    second = lambda + mu;
    rise = second * j;
    energy = 0.5 * rise * j;
  }
}

template <int Bytes>
GLISSON_INLINE Lanes<double, Bytes> loadAt(const double* values, std::size_t i) {
  return load<Lanes<double, Bytes>>(values + i);
}

template <SolidLaw law, int Bytes>
GLISSON_INLINE double forcesOf(const CellModes& modes, const CellRow<double, double>& row, const double* mu_,
                               const double* lambda_, bool& good) {
  using V = typename VectorOf<double, Bytes>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(double);
  V carry[4][3] = {};
  V total = {};
  for (std::size_t i = 0; i < row.n; i += lanes) {
    Triple<double, Bytes> d[7];
    loadModes(modes, row, i, d);
    const V mu = loadAt<Bytes>(mu_, i), lambda = loadAt<Bytes>(lambda_, i);
    Triple<double, Bytes> q[6];
    V trace, higher;
    dilatation(d, q, trace, higher);
    V square = {};
#pragma GCC unroll 7
    for (int m = 0; m < 7; ++m) square += modes.w[static_cast<std::size_t>(m)] * dot(d[m], d[m]);
    Triple<double, Bytes> s[7];
    if constexpr (law == SolidLaw::Linear) {
      // Only what is linear in d of g − e, and the trace.
      const V pressure = (lambda + mu) * trace;
      const Triple<double, Bytes> e[6] = {{d[2].z + d[1].y, -d[1].x, -d[2].x}, {-d[0].y, d[0].x + d[2].z, -d[2].y},
                                          {-d[0].z, -d[1].z, d[1].y + d[0].x}, {d[4].z, d[5].z, -d[4].x - d[5].y},
                                          {-d[3].z - d[5].y, d[5].x, d[3].x},  {d[4].y, -d[4].x - d[3].z, d[3].y}};
#pragma GCC unroll 6
      for (int m = 0; m < 6; ++m) s[m] = mu * (V(modes.w[static_cast<std::size_t>(m)] + V{}) * d[m] - e[m]);
      s[0].x += pressure;
      s[1].y += pressure;
      s[2].z += pressure;
      s[6] = (mu * modes.w[6]) * d[6];
      V work = {};
#pragma GCC unroll 7
      for (int m = 0; m < 7; ++m) work += dot(s[m], d[m]);
      total += 0.5 * work;
    } else {
      V j = trace + higher;
      if constexpr (law == SolidLaw::Logarithmic) {
        const auto bad = (mu > 0.0) & (j <= -1.0);
        for (std::size_t l = 0; l < lanes; ++l) good = good && bad[l] == 0;
        j = ((mu > 0.0) & (j > -1.0)) ? j : V{};
      }
      V rise, second, volume;
      volumeLaw<law, Bytes>(j, mu, lambda, rise, second, volume);
      total += mu * (0.5 * square - higher) + volume;
#pragma GCC unroll 6
      for (int m = 0; m < 6; ++m) s[m] = (mu * modes.w[static_cast<std::size_t>(m)]) * d[m] + (rise - mu) * q[m];
      s[0].x += rise;
      s[1].y += rise;
      s[2].z += rise;
      s[6] = (mu * modes.w[6]) * d[6];
    }
    storeModes(modes, row, i, s, carry);
  }
  storeLastNode<lanes>(row, carry);
  double sum = 0;
  for (std::size_t l = 0; l < lanes; ++l) sum += total[l];
  return sum;
}

template <SolidLaw law, int Bytes>
GLISSON_INLINE void lineariseOf(const CellModes& modes, const CellRow<double, double>& row, const double* mu_,
                                const double* lambda_, float* state) {
  using V = typename VectorOf<double, Bytes>::type;
  using F = typename VectorOf<float, Bytes / 2>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(double);
  for (std::size_t i = 0; i < row.n; i += lanes) {
    const auto keep = [&](std::size_t array, const V& value) __attribute__((always_inline)) {
      store<F>(state + TangentArrays::at(array, i), __builtin_convertvector(value, F));
    };
    Triple<double, Bytes> d[7];
    if constexpr (law == SolidLaw::Linear)
      for (auto& t : d) t = {V{}, V{}, V{}};
    else
      loadModes(modes, row, i, d);
    const V mu = loadAt<Bytes>(mu_, i), lambda = loadAt<Bytes>(lambda_, i);
    Triple<double, Bytes> q[6];
    V trace, higher;
    dilatation(d, q, trace, higher);
    V j = trace + higher;
    if constexpr (law == SolidLaw::Logarithmic) j = ((mu > 0.0) & (j > -0.999)) ? j : V{};
    V rise, second, volume;
    volumeLaw<law, Bytes>(j, mu, lambda, rise, second, volume);
    d[0].x += 1.0;
    d[1].y += 1.0;
    d[2].z += 1.0;
    // Largest eigenvalue of CᵀC from above: mean plus twice the root of a third of J2.
    const V a = dot(d[0], d[0]), b = dot(d[1], d[1]), c = dot(d[2], d[2]);
    const V ab = dot(d[0], d[1]), bc = dot(d[1], d[2]), ca = dot(d[2], d[0]);
    const V mean = (a + b + c) / 3.0;
    const V j2 = (a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean) +
                 2.0 * (ab * ab + bc * bc + ca * ca);
    V sigma = {};
    for (std::size_t l = 0; l < lanes; ++l) sigma[l] = std::sqrt(mean[l] + 2.0 * std::sqrt(j2[l] / 6.0));
    const V limit = mu / (sigma > 1e-6 ? sigma : V{} + 1e-6);
    const V p = rise - mu;
    V positive = p > limit ? limit : p;
    positive = positive < -limit ? -limit : positive;
#pragma GCC unroll 6
    for (std::size_t m = 0; m < 6; ++m) {
      keep(3 * m, d[m].x);
      keep(3 * m + 1, d[m].y);
      keep(3 * m + 2, d[m].z);
    }
    keep(TangentArrays::p, p);
    keep(TangentArrays::positive, positive);
    keep(TangentArrays::lambda, second > 0.0 ? second : V{});
    keep(TangentArrays::mu, mu);
  }
}

template <class T, int Bytes>
GLISSON_INLINE void gradients(const Triple<T, Bytes> (&c)[6], Triple<T, Bytes> (&g)[6]) {
  g[0] = cross(c[1], c[2]) + cross(c[3], c[5]);
  g[1] = cross(c[2], c[0]) + cross(c[4], c[3]);
  g[2] = cross(c[0], c[1]) + cross(c[5], c[4]);
  g[3] = cross(c[1], c[4]) + cross(c[5], c[0]);
  g[4] = cross(c[3], c[1]) + cross(c[2], c[5]);
  g[5] = cross(c[4], c[2]) + cross(c[0], c[3]);
}

template <int Bytes>
GLISSON_INLINE void loadState(const float* state, std::size_t i, Triple<float, Bytes> (&c)[6]) {
  using V = Lanes<float, Bytes>;
#pragma GCC unroll 6
  for (std::size_t m = 0; m < 6; ++m)
    c[m] = {load<V>(state + TangentArrays::at(3 * m, i)), load<V>(state + TangentArrays::at(3 * m + 1, i)),
            load<V>(state + TangentArrays::at(3 * m + 2, i))};
}

template <int Bytes>
GLISSON_INLINE void tangentOf(const CellModes& modes, const CellRow<float, float>& row, const float* state,
                              std::size_t pressure) {
  using V = typename VectorOf<float, Bytes>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(float);
  V carry[4][3] = {};
  for (std::size_t i = 0; i < row.n; i += lanes) {
    const auto at = [&](std::size_t array) __attribute__((always_inline)) {
      return load<V>(state + TangentArrays::at(array, i));
    };
    Triple<float, Bytes> d[7], c[6], g[6], s[7];
    loadModes(modes, row, i, d);
    loadState(state, i, c);
    gradients(c, g);
    V along = dot(g[0], d[0]);
#pragma GCC unroll 5
    for (int m = 1; m < 6; ++m) along += dot(g[m], d[m]);
    along *= at(TangentArrays::lambda);
    const V mu = at(TangentArrays::mu), p = at(pressure);
    const auto mode = [&](int m, const Triple<float, Bytes>& turned) __attribute__((always_inline)) {
      const V share = mu * static_cast<float>(modes.w[static_cast<std::size_t>(m)]);
      s[m] = share * d[m] + p * turned + along * g[m];
    };
    mode(0, cross(d[1], c[2]) + cross(c[1], d[2]) + cross(d[3], c[5]) + cross(c[3], d[5]));
    mode(1, cross(d[2], c[0]) + cross(c[2], d[0]) + cross(d[4], c[3]) + cross(c[4], d[3]));
    mode(2, cross(d[0], c[1]) + cross(c[0], d[1]) + cross(d[5], c[4]) + cross(c[5], d[4]));
    mode(3, cross(d[1], c[4]) + cross(c[1], d[4]) + cross(d[5], c[0]) + cross(c[5], d[0]));
    mode(4, cross(d[3], c[1]) + cross(c[3], d[1]) + cross(d[2], c[5]) + cross(c[2], d[5]));
    mode(5, cross(d[4], c[2]) + cross(c[4], d[2]) + cross(d[0], c[3]) + cross(c[0], d[3]));
    s[6] = (mu * static_cast<float>(modes.w[6])) * d[6];
    storeModes(modes, row, i, s, carry);
  }
  storeLastNode<lanes>(row, carry);
}

template <int Bytes>
GLISSON_INLINE void diagonalOf(const CellModes& modes, float* const out[4], std::size_t nodes, std::size_t n,
                               const float* state) {
  using V = typename VectorOf<float, Bytes>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(float);
  float even = 0;
  for (std::size_t m = 0; m < 7; ++m) even += static_cast<float>(modes.w[m] * modes.alpha[m] * modes.alpha[m]);
  V carry[4][6] = {};
  for (std::size_t i = 0; i < n; i += lanes) {
    const auto at = [&](std::size_t array) __attribute__((always_inline)) {
      return load<V>(state + TangentArrays::at(array, i));
    };
    Triple<float, Bytes> c[6], g[6];
    loadState(state, i, c);
    gradients(c, g);
    V w[2][4][3] = {};
#pragma GCC unroll 6
    for (int m = 0; m < 6; ++m) {
      const int p = CellModes::walsh[static_cast<std::size_t>(m)];
      const float a = static_cast<float>(modes.alpha[static_cast<std::size_t>(m)]);
      w[p & 1][p >> 1][0] = a * g[m].x;
      w[p & 1][p >> 1][1] = a * g[m].y;
      w[p & 1][p >> 1][2] = a * g[m].z;
    }
    transformRows(w);
    const V lambda = at(TangentArrays::lambda), mu = even * at(TangentArrays::mu);
#pragma GCC unroll 4
    for (int r = 0; r < 4; ++r) {
      V left[3], right[3];
      for (int k = 0; k < 3; ++k) {
        left[k] = w[0][r][k] + w[1][r][k];
        right[k] = w[0][r][k] - w[1][r][k];
      }
      std::size_t entry = 0;
      for (int k = 0; k < 3; ++k)
        for (int l = k; l < 3; ++l, ++entry) {
          const V toLeft = lambda * left[k] * left[l] + (k == l ? mu : V{});
          const V toRight = lambda * right[k] * right[l] + (k == l ? mu : V{});
          V shifted;
          shiftIn(carry[r][entry], toRight, shifted, std::make_index_sequence<lanes>{});
          carry[r][entry] = toRight;
          float* sum = out[r] + entry * nodes + i;
          store<V>(sum, load<V>(sum) + (toLeft + shifted));
        }
    }
  }
  for (int r = 0; r < 4; ++r)
    for (std::size_t entry = 0; entry < 6; ++entry) out[r][entry * nodes + n] += carry[r][entry][lanes - 1];
}

template <int Bytes>
GLISSON_INLINE double smallestOf(const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                                 double smallest) {
  using V = typename VectorOf<double, Bytes>::type;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(double);
  for (std::size_t i = 0; i < row.n; i += lanes) {
    Triple<double, Bytes> d[7], q[6];
    loadModes(modes, row, i, d);
    V trace, higher;
    dilatation(d, q, trace, higher);
    for (std::size_t l = 0; l < lanes; ++l)
      if (mu[i + l] > 0 && 1 + trace[l] + higher[l] < smallest) smallest = 1 + trace[l] + higher[l];
  }
  return smallest;
}

/// The five kernels for one instruction set.
template <int Bytes>
struct Kernels {
  GLISSON_INLINE static double forces(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row,
                                      const double* mu, const double* lambda, bool& good) {
    if (law == SolidLaw::Polynomial) return forcesOf<SolidLaw::Polynomial, Bytes>(modes, row, mu, lambda, good);
    if (law == SolidLaw::Logarithmic) return forcesOf<SolidLaw::Logarithmic, Bytes>(modes, row, mu, lambda, good);
    return forcesOf<SolidLaw::Linear, Bytes>(modes, row, mu, lambda, good);
  }
  GLISSON_INLINE static void linearise(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row,
                                       const double* mu, const double* lambda, float* state) {
    if (law == SolidLaw::Polynomial)
      lineariseOf<SolidLaw::Polynomial, Bytes>(modes, row, mu, lambda, state);
    else if (law == SolidLaw::Logarithmic)
      lineariseOf<SolidLaw::Logarithmic, Bytes>(modes, row, mu, lambda, state);
    else
      lineariseOf<SolidLaw::Linear, Bytes>(modes, row, mu, lambda, state);
  }
};

struct Table {
  double (*forces)(SolidLaw, const CellModes&, const CellRow<double, double>&, const double*, const double*, bool&);
  void (*linearise)(SolidLaw, const CellModes&, const CellRow<double, double>&, const double*, const double*, float*);
  void (*tangent)(const CellModes&, const CellRow<float, float>&, const float*, std::size_t);
  void (*diagonal)(const CellModes&, float* const[4], std::size_t, std::size_t, const float*);
  double (*smallest)(const CellModes&, const CellRow<double, double>&, const double*, double);
};

#define GLISSON_KERNELS(name, bytes, attribute)                                                                 \
  attribute double forces##name(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row,       \
                                const double* mu, const double* lambda, bool& good) {                           \
    return Kernels<bytes>::forces(law, modes, row, mu, lambda, good);                                           \
  }                                                                                                             \
  attribute void linearise##name(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row,      \
                                 const double* mu, const double* lambda, float* state) {                        \
    Kernels<bytes>::linearise(law, modes, row, mu, lambda, state);                                              \
  }                                                                                                             \
  attribute void tangent##name(const CellModes& modes, const CellRow<float, float>& row, const float* state,    \
                               std::size_t pressure) {                                                          \
    tangentOf<bytes>(modes, row, state, pressure);                                                              \
  }                                                                                                             \
  attribute void diagonal##name(const CellModes& modes, float* const out[4], std::size_t nodes, std::size_t n,  \
                                const float* state) {                                                           \
    diagonalOf<bytes>(modes, out, nodes, n, state);                                                             \
  }                                                                                                             \
  attribute double smallest##name(const CellModes& modes, const CellRow<double, double>& row, const double* mu, \
                                  double start) {                                                               \
    return smallestOf<bytes>(modes, row, mu, start);                                                            \
  }                                                                                                             \
  constexpr Table table##name = {&forces##name, &linearise##name, &tangent##name, &diagonal##name, &smallest##name};

GLISSON_KERNELS(Portable, 16, )
#if defined(__x86_64__)
GLISSON_KERNELS(Avx2, 32, __attribute__((target("arch=x86-64-v3"))))
GLISSON_KERNELS(Avx512, 64, GLISSON_AVX512)
#endif

const Table& fastest() {
  static const Table& table = [&]() -> const Table& {
#if defined(__x86_64__)
    switch (instructionSet()) {
      case InstructionSet::Avx512: return tableAvx512;
      case InstructionSet::Avx2: return tableAvx2;
      default: break;
    }
#endif
    return tablePortable;
  }();
  return table;
}

}  // namespace

CellModes::CellModes(const Eigen::Vector3d& h) {
  const double third = 1.0 / std::sqrt(3.0);
  // Over each mode: the edge whose inverse scales it, see the docstring's identities.
  const std::array<double, 7> edge = {h.x(), h.y(), h.z(), h.z(), h.x(), h.y(), h.x()};
  const std::array<int, 7> bits = {1, 1, 1, 2, 2, 2, 3};
  for (std::size_t m = 0; m < 7; ++m) {
    alpha[m] = (bits[m] % 2 == 0 ? 1.0 : -1.0) * 0.25 / edge[m];
    if (bits[m] == 2) alpha[m] *= third;
  }
  const auto square = [](double v) { return v * v; };
  w = {1,
       1,
       1,
       square(h.z() / h.x()) + square(h.z() / h.y()),
       square(h.x() / h.y()) + square(h.x() / h.z()),
       square(h.y() / h.z()) + square(h.y() / h.x()),
       (1 + square(h.x() / h.y()) + square(h.x() / h.z())) / 9.0};
}

double addCellForces(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                     const double* lambda, bool& good) {
  return fastest().forces(law, modes, row, mu, lambda, good);
}

void lineariseCells(SolidLaw law, const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                    const double* lambda, float* state) {
  fastest().linearise(law, modes, row, mu, lambda, state);
}

void addCellTangent(const CellModes& modes, const CellRow<float, float>& row, const float* state, bool positive) {
  fastest().tangent(modes, row, state, positive ? TangentArrays::positive : TangentArrays::p);
}

void addCellDiagonal(const CellModes& modes, float* const out[4], std::size_t nodes, std::size_t n,
                     const float* state) {
  fastest().diagonal(modes, out, nodes, n, state);
}

double smallestVolumeRatio(const CellModes& modes, const CellRow<double, double>& row, const double* mu,
                           double smallest) {
  return fastest().smallest(modes, row, mu, smallest);
}

}  // namespace glisson::mechanics
