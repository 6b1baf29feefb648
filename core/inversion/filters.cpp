// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/filters.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"
#include "inversion/detail/window.h"

namespace glisson::inversion {

void curl(Waves& waves, double radius_mm, int dimensions, const Progress& progress) {
  if (waves.directions.size() != 3)
    throw BadInput("the curl needs three motion-encoding directions; there are " +
                   std::to_string(waves.directions.size()));
  Eigen::Matrix3d encodings;  // rows
  for (int d = 0; d < 3; ++d) encodings.row(d) = waves.directions[static_cast<std::size_t>(d)].encoding_lps;
  if (std::abs(encodings.determinant()) < 0.1)
    throw BadInput(
        "the curl needs to know three motion-encoding directions that span space; give them, or use the "
        "high-pass filter");
  // Motion along the index axes from motion along the encodings.
  const Eigen::Matrix3d toIndex = waves.grid.direction.transpose() * encodings.inverse();
  const Stencil stencil(waves.grid.spacing_mm, radius_mm, dimensions);
  const detail::Window window(waves.grid, stencil);
  const image::Mask inner = window.complete(waves.mask);
  if (image::count(inner) == 0)
    throw BadInput("nowhere in the mask is there room for the window of the curl; take a smaller window");

  const std::size_t components = dimensions == 2 ? 1 : 3;
  const std::size_t noises = waves.directions.front().noise.size();
  std::vector<Waves::Direction> result(components);
  for (std::size_t field = 0; field <= noises; ++field) {
    progress.report(static_cast<double>(field) / static_cast<double>(noises + 1), "curl");
    std::array<const ComplexVolume*, 3> u{};
    for (std::size_t d = 0; d < 3; ++d)
      u[d] = field == 0 ? &waves.directions[d].wave : &waves.directions[d].noise[field - 1];
    std::vector<ComplexVolume> out(components, ComplexVolume(waves.grid));
    detail::forEachVoxel(inner, progress, [&](std::size_t v) {
      Eigen::Matrix3cd gradient = Eigen::Matrix3cd::Zero();  // row: direction, column: derivative
      for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t t = 0; t < window.size(); ++t)
          gradient.row(static_cast<Eigen::Index>(d)) +=
              std::complex<double>(u[d]->values[window.neighbour(v, t)]) *
              stencil.taps()[t].gradient.transpose().cast<std::complex<double>>();
      const Eigen::Matrix3cd g = toIndex.cast<std::complex<double>>() * gradient;
      out[components - 1].values[v] = std::complex<float>(g(1, 0) - g(0, 1));
      if (components == 3) {
        out[0].values[v] = std::complex<float>(g(2, 1) - g(1, 2));
        out[1].values[v] = std::complex<float>(g(0, 2) - g(2, 0));
      }
    });
    for (std::size_t c = 0; c < components; ++c) {
      if (field == 0)
        result[c].wave = std::move(out[c]);
      else
        result[c].noise.push_back(std::move(out[c]));
    }
  }
  for (std::size_t c = 0; c < components; ++c) {
    const auto axis = static_cast<Eigen::Index>(components == 1 ? 2 : c);
    result[c].encoding_lps = waves.grid.direction.col(axis);
    for (const Waves::Direction& d : waves.directions) {
      result[c].spatiallyUnwrapped = result[c].spatiallyUnwrapped || d.spatiallyUnwrapped;
      result[c].jumping = std::max(result[c].jumping, d.jumping);
      result[c].noise_rad = std::max(result[c].noise_rad, d.noise_rad);
    }
  }
  waves.directions = std::move(result);
  waves.mask = inner;
}

}  // namespace glisson::inversion
