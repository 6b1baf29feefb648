#pragma once

#include <cstddef>
#include <utility>

#define GLISSON_INLINE inline __attribute__((always_inline))

namespace glisson::mechanics {

/// Bytes per vector register, as a type of the compiler's own vector extension.
template <class T, int Bytes>
struct VectorOf {
  typedef T type __attribute__((vector_size(Bytes), aligned(alignof(T)), may_alias));
};

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

/// Vector instructions of this processor that kernels are made for.
enum class InstructionSet { Portable, Avx2, Avx512 };

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
