// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace glisson {

/// Number of threads that the loops below use; 0 asks for one per core. Default: one per core.
void setThreadCount(int threads);
int threadCount();

/// Calls body(begin, end) for consecutive chunks of [0, n). Chunk borders depend on n and chunk only, never on the
/// number of threads, so that a result made chunk by chunk is the same to the last bit with any number of threads.
/// The first exception thrown by a chunk is rethrown here.
void parallelChunks(std::size_t n, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body);

/// Sum over chunks of body(begin, end), added in chunk order: the same bits with any number of threads.
double parallelSum(std::size_t n, std::size_t chunk, const std::function<double(std::size_t, std::size_t)>& body);

}  // namespace glisson
