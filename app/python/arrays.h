// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <vector>

#include "image/volume.h"

namespace glisson::python {

/// A read-only array over memory of core: nothing is copied, and the array keeps `owner`, the Python object that the
/// memory belongs to, alive. strides in bytes.
template <typename T>
pybind11::array view(const T* data, const std::vector<pybind11::ssize_t>& shape,
                     const std::vector<pybind11::ssize_t>& strides, pybind11::handle owner) {
  pybind11::array a(pybind11::dtype::of<T>(), shape, strides, data, owner);
  a.attr("setflags")(pybind11::arg("write") = false);
  return a;
}

/// Voxel values as array[i, j, k] (i fastest in memory, Fortran order); Bytes of a mask become bool.
template <typename Shown, typename T>
pybind11::array viewOf(const image::Volume<T>& v, pybind11::handle owner) {
  static_assert(sizeof(Shown) == sizeof(T));
  const Eigen::Vector3i n = v.grid.size;
  const pybind11::ssize_t one = sizeof(T);
  return view(reinterpret_cast<const Shown*>(v.values.data()), {n.x(), n.y(), n.z()},
              {one, one * n.x(), one * n.x() * n.y()}, owner);
}

/// A displacement field as array[i, j, k, component].
inline pybind11::array viewOf(const image::DisplacementField& u, pybind11::handle owner) {
  const Eigen::Vector3i n = u.grid.size;
  const pybind11::ssize_t one = sizeof(Eigen::Vector3f);
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  return view(reinterpret_cast<const float*>(u.values.data()), {n.x(), n.y(), n.z(), 3},
              {one, one * n.x(), one * n.x() * n.y(), static_cast<pybind11::ssize_t>(sizeof(float))}, owner);
}

/// Points as array[n, 3].
inline pybind11::array viewOf(const std::vector<Eigen::Vector3d>& points, pybind11::handle owner) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return view(reinterpret_cast<const double*>(points.data()), {static_cast<pybind11::ssize_t>(points.size()), 3},
              {sizeof(Eigen::Vector3d), sizeof(double)}, owner);
}

/// Numbers as array[n].
inline pybind11::array viewOf(const std::vector<double>& numbers, pybind11::handle owner) {
  return view(numbers.data(), {static_cast<pybind11::ssize_t>(numbers.size())}, {sizeof(double)}, owner);
}

/// Points of an array[n, 3]; copied. Throws BadArgument for any other shape.
std::vector<Eigen::Vector3d> pointsOf(
    const pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>& a);

}  // namespace glisson::python
