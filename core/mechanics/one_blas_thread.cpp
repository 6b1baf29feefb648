// SPDX-License-Identifier: GPL-3.0-or-later
#include <mutex>

#include "mechanics/detail/one_blas_thread.h"

extern "C" {
void openblas_set_num_threads(int threads);
int openblas_get_num_threads();
}

namespace glisson::mechanics {
namespace {

struct Users {
  std::mutex mutex;
  int count = 0;
  int threadsBefore = 1;
};

Users& users() {
  static Users all;
  return all;
}

}  // namespace

OneBlasThread::OneBlasThread() {
  Users& all = users();
  const std::lock_guard lock(all.mutex);
  if (all.count++ > 0) return;
  all.threadsBefore = openblas_get_num_threads();
  if (all.threadsBefore != 1) openblas_set_num_threads(1);
}

OneBlasThread::~OneBlasThread() {
  Users& all = users();
  const std::lock_guard lock(all.mutex);
  if (--all.count == 0 && all.threadsBefore != 1) openblas_set_num_threads(all.threadsBefore);
}

}  // namespace glisson::mechanics
