// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glisson::mechanics {

/// BLAS on one thread while any of these lives: its sums would depend on the number of threads otherwise. Several may
/// live at once, on several threads; the last of them gives BLAS back the number that the first one found.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

}  // namespace glisson::mechanics
