// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "base/parallel.h"
#include "mechanics/row_lattice.h"

namespace glisson::mechanics {

/// Cell layers of a lattice in chunks, two colours, so that threads never add to the same node layer at once and the
/// bits do not depend on their number. clear(from, to): node layers [from, to), before anything is added to them;
/// layer(k): cell layer k.
template <class Clear, class Layer>
void sweepLayers(const RowLattice& L, const Clear& clear, const Layer& layer) {
  const int layers = L.cells().z();
  const int perChunk = L.layersPerChunk();
  const int chunks = (layers + perChunk - 1) / perChunk;
  // Neighbouring chunks share a node layer: even chunks first, then odd ones. Each clears the layers it is first to
  // see.
  for (int colour = 0; colour < 2; ++colour)
    parallelChunks(static_cast<std::size_t>((chunks + 1 - colour) / 2), 1, [&](std::size_t t, std::size_t) {
      const int chunk = 2 * static_cast<int>(t) + colour;
      const int from = chunk * perChunk;
      const int to = std::min(layers, from + perChunk);
      const bool last = chunk == chunks - 1;
      clear(colour == 0 ? from : from + 1, colour == 0 || last ? to + 1 : to);
      for (int k = from; k < to; ++k) layer(k);
    });
}

}  // namespace glisson::mechanics
