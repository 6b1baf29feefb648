// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>

#include "mechanics/contact/cell_kernel.h"
#include "mechanics/vector_lanes.h"

/// What the kernels of trilinear cells share, for any width of the registers: vectors of three, the way from nodes to
/// modes and back, and the dilatation.
namespace glisson::mechanics {

/// A register of `Bytes` bytes of values T, one per cell.
template <class T, int Bytes>
using Lanes = typename VectorOf<T, Bytes>::type;

/// A vector of three whose components are registers of cells.
template <class T, int Bytes>
struct Triple {
  Lanes<T, Bytes> x, y, z;
};
template <class T, int B>
GLISSON_INLINE Triple<T, B> operator+(const Triple<T, B>& a, const Triple<T, B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T, int B>
GLISSON_INLINE Triple<T, B> operator-(const Triple<T, B>& a, const Triple<T, B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T, int B>
GLISSON_INLINE Triple<T, B> operator*(const Lanes<T, B>& s, const Triple<T, B>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T, int B>
GLISSON_INLINE Lanes<T, B> dot(const Triple<T, B>& a, const Triple<T, B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T, int B>
GLISSON_INLINE Triple<T, B> cross(const Triple<T, B>& a, const Triple<T, B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Differences along x, then Walsh-Hadamard along y and z: the seven modes of a vector of cells.
template <class T, int Bytes, class Row>
GLISSON_INLINE void loadModes(const CellModes& modes, const Row& row, std::size_t i, Triple<T, Bytes> (&d)[7]) {
  using V = Lanes<T, Bytes>;
  V w[2][4][3];
  loadRows(row, i, w);
  transformRows(w);
#pragma GCC unroll 7
  for (int m = 0; m < 7; ++m) {
    const int p = CellModes::walsh[static_cast<std::size_t>(m)];
    const T a = static_cast<T>(modes.alpha[static_cast<std::size_t>(m)]);
    d[m] = {a * w[p & 1][p >> 1][0], a * w[p & 1][p >> 1][1], a * w[p & 1][p >> 1][2]};
  }
}

/// Back from modes to the two nodes of each row; what belongs to the next vector's first node is carried.
template <class T, int Bytes, class Row>
GLISSON_INLINE void storeModes(const CellModes& modes, const Row& row, std::size_t i, const Triple<T, Bytes> (&s)[7],
                               Lanes<T, Bytes> (&carry)[4][3]) {
  using V = Lanes<T, Bytes>;
  constexpr std::size_t lanes = static_cast<std::size_t>(Bytes) / sizeof(T);
  V w[2][4][3] = {};
#pragma GCC unroll 7
  for (int m = 0; m < 7; ++m) {
    const int p = CellModes::walsh[static_cast<std::size_t>(m)];
    const T a = static_cast<T>(modes.alpha[static_cast<std::size_t>(m)]);
    w[p & 1][p >> 1][0] = a * s[m].x;
    w[p & 1][p >> 1][1] = a * s[m].y;
    w[p & 1][p >> 1][2] = a * s[m].z;
  }
  transformRows(w);
  storeRows<lanes>(row, i, w, carry);
}

/// What the energy is made of, without cancellation for small displacements: g_m − e_m and the second- and third-order
/// part of J.
template <class T, int Bytes>
GLISSON_INLINE void dilatation(const Triple<T, Bytes> (&d)[7], Triple<T, Bytes> (&q)[6], Lanes<T, Bytes>& trace,
                               Lanes<T, Bytes>& higher) {
  using Three = Triple<T, Bytes>;
  const Three d23 = cross(d[1], d[2]), d31 = cross(d[2], d[0]), d12 = cross(d[0], d[1]);
  const Three h46 = cross(d[3], d[5]), h54 = cross(d[4], d[3]), h65 = cross(d[5], d[4]);
  // e_i × d_j written out.
  q[0] = Three{d[2].z + d[1].y, -d[1].x, -d[2].x} + d23 + h46;
  q[1] = Three{-d[0].y, d[0].x + d[2].z, -d[2].y} + d31 + h54;
  q[2] = Three{-d[0].z, -d[1].z, d[1].y + d[0].x} + d12 + h65;
  q[3] = Three{d[4].z, d[5].z, -d[4].x - d[5].y} + cross(d[1], d[4]) + cross(d[5], d[0]);
  q[4] = Three{-d[3].z - d[5].y, d[5].x, d[3].x} + cross(d[3], d[1]) + cross(d[2], d[5]);
  q[5] = Three{d[4].y, -d[4].x - d[3].z, d[3].y} + cross(d[4], d[2]) + cross(d[0], d[3]);
  trace = d[0].x + d[1].y + d[2].z;
  // [c1 c2 c3] − 1 − trace = d1·(e2×d3 + d2×e3 + d2×d3) + (d2×d3)·e1, and the three triple products of ηζ, ζξ, ξη.
  const Three inner = Three{d[2].z + d[1].y, -d[1].x, -d[2].x} + d23;
  higher = dot(d[0], inner) + d23.x + h46.x + dot(d[0], h46) + h54.y + dot(d[1], h54) + h65.z + dot(d[2], h65);
}

}  // namespace glisson::mechanics
