// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/smoother_kernel.h"

#include "mechanics/vector_lanes.h"

namespace glisson::mechanics {
namespace {

/// V: a vector of nodes, or one.
template <class V, bool first>
GLISSON_INLINE void stepAt(const SmootherFields& f, std::size_t i, float keep, float gain, bool fromZero) {
  const std::size_t n = f.nodes;
  const auto at = [](const float* p) __attribute__((always_inline)) {
    return load<V>(p);
  };
  V r[3];
#pragma GCC unroll 3
  for (std::size_t c = 0; c < 3; ++c) {
    r[c] = at(f.residual + c * n + i);
    if constexpr (!first) store<V>(f.residual + c * n + i, r[c] -= at(f.product + c * n + i));
  }
  const V xx = at(f.block + i), xy = at(f.block + n + i), xz = at(f.block + 2 * n + i);
  const V yy = at(f.block + 3 * n + i), yz = at(f.block + 4 * n + i), zz = at(f.block + 5 * n + i);
  V d[3] = {gain * (xx * r[0] + xy * r[1] + xz * r[2]), gain * (xy * r[0] + yy * r[1] + yz * r[2]),
            gain * (xz * r[0] + yz * r[1] + zz * r[2])};
#pragma GCC unroll 3
  for (std::size_t c = 0; c < 3; ++c) {
    if constexpr (!first) d[c] += keep * at(f.step + c * n + i);
    store<V>(f.step + c * n + i, d[c]);
    store<V>(f.sum + c * n + i, fromZero ? d[c] : at(f.sum + c * n + i) + d[c]);
  }
}

template <int Bytes, bool first>
GLISSON_INLINE void stepsOf(const SmootherFields& f, std::size_t begin, std::size_t end, float keep, float gain,
                            bool fromZero) {
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(float);
  std::size_t i = begin;
  for (; i + lanes <= end; i += lanes) stepAt<typename VectorOf<float, Bytes>::type, first>(f, i, keep, gain, fromZero);
  for (; i < end; ++i) stepAt<float, first>(f, i, keep, gain, fromZero);
}

using Steps = void (*)(const SmootherFields&, std::size_t, std::size_t, float, float, bool, bool);

#define GLISSON_SMOOTHER(name, bytes, attribute)                                                                  \
  attribute void steps##name(const SmootherFields& f, std::size_t begin, std::size_t end, float keep, float gain, \
                             bool first, bool fromZero) {                                                         \
    if (first)                                                                                                    \
      stepsOf<bytes, true>(f, begin, end, keep, gain, fromZero);                                                  \
    else                                                                                                          \
      stepsOf<bytes, false>(f, begin, end, keep, gain, fromZero);                                                 \
  }

GLISSON_SMOOTHER(Portable, 16, )
#if defined(__x86_64__)
GLISSON_SMOOTHER(Avx2, 32, __attribute__((target("arch=x86-64-v3"))))
GLISSON_SMOOTHER(Avx512, 64, GLISSON_AVX512)
#endif

Steps fastest() {
#if defined(__x86_64__)
  switch (instructionSet()) {
    case InstructionSet::Avx512: return &stepsAvx512;
    case InstructionSet::Avx2: return &stepsAvx2;
    default: break;
  }
#endif
  return &stepsPortable;
}

}  // namespace

void smoothNodes(const SmootherFields& fields, std::size_t begin, std::size_t end, float keep, float gain, bool first,
                 bool fromZero) {
  static const Steps steps = fastest();
  steps(fields, begin, end, keep, gain, first, fromZero);
}

}  // namespace glisson::mechanics
