// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace glisson::mechanics {

/// What a step of a block-Jacobi Chebyshev smoother reads and writes: fields of three arrays of `nodes` values.
struct SmootherFields {
  std::size_t nodes = 0;
  const float* block;    ///< inverse diagonal blocks, six arrays: xx xy xz yy yz zz
  const float* product;  ///< matrix times step; not read at the first step
  float* residual;
  float* step;
  float* sum;
};

/// Over nodes [begin, end), in one pass: residual −= product (not at the first step), step = keep step + gain block
/// residual, sum += step (or = step).
void smoothNodes(const SmootherFields& fields, std::size_t begin, std::size_t end, float keep, float gain, bool first,
                 bool fromZero);

}  // namespace glisson::mechanics
