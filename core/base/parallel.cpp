// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "base/error.h"

namespace glisson {
namespace {

struct Arena {
  std::mutex guard;
  int threads = 0;
  std::shared_ptr<tbb::task_arena> arena;

  std::shared_ptr<tbb::task_arena> get() {
    const std::lock_guard lock(guard);
    if (!arena) arena = std::make_shared<tbb::task_arena>(threads > 0 ? threads : tbb::info::default_concurrency());
    return arena;
  }
};

Arena& theArena() {
  static Arena arena;
  return arena;
}

}  // namespace

void setThreadCount(int threads) {
  if (threads < 0) throw BadArgument("setThreadCount: " + std::to_string(threads) + " threads; give 0 or more");
  Arena& a = theArena();
  const std::lock_guard lock(a.guard);
  a.threads = threads;
  a.arena.reset();
}

int threadCount() {
  return theArena().get()->max_concurrency();
}

void parallelChunks(std::size_t n, std::size_t chunk, const std::function<void(std::size_t, std::size_t)>& body) {
  if (chunk == 0) throw BadArgument("parallelChunks: chunk must be at least 1");
  if (n == 0) return;
  const std::size_t chunks = (n + chunk - 1) / chunk;
  auto run = [&](std::size_t c) { body(c * chunk, std::min(n, (c + 1) * chunk)); };
  const auto arena = theArena().get();
  if (chunks == 1 || arena->max_concurrency() == 1) {
    for (std::size_t c = 0; c < chunks; ++c) run(c);
    return;
  }
  arena->execute([&] { tbb::parallel_for(std::size_t{0}, chunks, run); });
}

double parallelSum(std::size_t n, std::size_t chunk, const std::function<double(std::size_t, std::size_t)>& body) {
  if (chunk == 0) throw BadArgument("parallelSum: chunk must be at least 1");
  std::vector<double> partial((n + chunk - 1) / chunk, 0.0);
  parallelChunks(n, chunk, [&](std::size_t begin, std::size_t end) { partial[begin / chunk] = body(begin, end); });
  double sum = 0.0;
  for (const double p : partial) sum += p;
  return sum;
}

}  // namespace glisson
