// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Before a function: it is compiled once more for wider vector registers, and the machine takes that where it has
/// them. Without fused multiply-add, so that the bits are the same either way.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define GLISSON_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define GLISSON_WIDE
#endif
