// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstring>
#include <utility>

#define GLISSON_INLINE inline __attribute__((always_inline))

// What GCC and clang write differently: a loop whose iterations do not depend on each other; functions for AVX-512.
#if defined(__clang__)
#define GLISSON_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#define GLISSON_AVX512 __attribute__((target("arch=x86-64-v4")))
#else
#define GLISSON_INDEPENDENT _Pragma("GCC ivdep")
#define GLISSON_AVX512 __attribute__((target("arch=x86-64-v4,prefer-vector-width=512")))
#endif

namespace glisson::mechanics {

/// Bytes per vector register, as a type of the compiler's own vector extension. Values in memory are aligned as T only:
/// load and store read and write them.
template <class T, int Bytes>
struct VectorOf {
#if defined(__clang__)  // which drops the alignment of a template's argument, so that callers and callees would differ
  typedef T type __attribute__((vector_size(Bytes), may_alias));
#else
  typedef T type __attribute__((vector_size(Bytes), aligned(alignof(T)), may_alias));
#endif
};

/// The vector at p.
template <class V, class T>
GLISSON_INLINE V load(const T* p) {
#if defined(__clang__)
  V v;
  std::memcpy(&v, p, sizeof v);
  return v;
#else
  return *reinterpret_cast<const V*>(p);
#endif
}
/// Writes a vector at p.
template <class V, class T>
GLISSON_INLINE void store(T* p, const V& v) {
#if defined(__clang__)
  std::memcpy(p, &v, sizeof v);
#else
  *reinterpret_cast<V*>(p) = v;
#endif
}

/// (last lane of previous, lanes 0 .. W − 2 of current).
template <class V, std::size_t... lane>
GLISSON_INLINE void shiftIn(const V& previous, const V& current, V& shifted, std::index_sequence<lane...>) {
  shifted = __builtin_shufflevector(previous, current, static_cast<int>(sizeof...(lane) - 1 + lane)...);
}

/// Sum and difference of two values, in place.
template <class V>
GLISSON_INLINE void butterfly(V& a, V& b) {
  const V sum = a + b;
  b = a - b;
  a = sum;
}

/// Walsh-Hadamard along axes y and z over w[mx][row], row = y + 2 z.
template <class V>
GLISSON_INLINE void transformRows(V (&w)[2][4][3]) {
  for (int m = 0; m < 2; ++m)
    for (int c = 0; c < 3; ++c) {
      butterfly(w[m][0][c], w[m][1][c]);
      butterfly(w[m][2][c], w[m][3][c]);
      butterfly(w[m][0][c], w[m][2][c]);
      butterfly(w[m][1][c], w[m][3][c]);
    }
}

/// The two nodes of each cell of a row: sums and differences along x, in[row][component] + i being the first node's.
template <class V, class Row>
GLISSON_INLINE void loadRows(const Row& row, std::size_t i, V (&w)[2][4][3]) {
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r)
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      const V left = load<V>(row.in[r][c] + i);
      const V right = load<V>(row.in[r][c] + i + 1);
      w[0][r][c] = left + right;
      w[1][r][c] = left - right;
    }
}

/// The way back, added to row.out; what belongs to the next vector's first node is carried.
template <std::size_t lanes, class V, class Row>
GLISSON_INLINE void storeRows(const Row& row, std::size_t i, const V (&w)[2][4][3], V (&carry)[4][3]) {
#pragma GCC unroll 4
  for (int r = 0; r < 4; ++r)
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      const V toLeft = w[0][r][c] + w[1][r][c];
      const V toRight = w[0][r][c] - w[1][r][c];
      V shifted;
      shiftIn(carry[r][c], toRight, shifted, std::make_index_sequence<lanes>{});
      carry[r][c] = toRight;
      store<V>(row.out[r][c] + i, load<V>(row.out[r][c] + i) + (toLeft + shifted));
    }
}

/// The last node of the row.
template <std::size_t lanes, class V, class Row>
GLISSON_INLINE void storeLastNode(const Row& row, const V (&carry)[4][3]) {
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 3; ++c) row.out[r][c][row.n] += carry[r][c][lanes - 1];
}

/// Vector instructions of this processor that kernels are made for.
enum class InstructionSet { Portable, Avx2, Avx512 };

/// The widest of them that this processor has.
inline InstructionSet instructionSet() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
    return InstructionSet::Avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return InstructionSet::Avx2;
#endif
  return InstructionSet::Portable;
}

}  // namespace glisson::mechanics
