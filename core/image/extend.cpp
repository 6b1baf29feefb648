// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/extend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"

namespace glisson::image {

DisplacementField extendHarmonically(const DisplacementField& u_mm, const Mask& inside, double margin_mm) {
  if (u_mm.values.size() != inside.values.size())
    throw BadArgument("extendHarmonically: field and mask have different grids");
  const Grid& g = u_mm.grid;
  const Eigen::Vector3i pad =
      (Eigen::Vector3d::Constant(margin_mm).cwiseQuotient(g.spacing_mm)).array().ceil().cast<int>();
  Grid wide = g;
  wide.size = g.size + 2 * pad;
  wide.origin_lps_mm = g.indexToLps(-pad.cast<double>());

  DisplacementField out(wide, Eigen::Vector3f::Zero());
  Mask known(wide);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        if (!inside.at(i, j, k)) continue;
        out.at(i + pad.x(), j + pad.y(), k + pad.z()) = u_mm.at(i, j, k);
        known.at(i + pad.x(), j + pad.y(), k + pad.z()) = 1;
      }

  // Successive over-relaxation, red-black by planes of i + j + k so that threads do not change bits; the outermost
  // layer stays zero. Weights follow the spacing of each axis.
  const Eigen::Vector3d w = g.spacing_mm.cwiseAbs2().cwiseInverse();
  const auto wx = static_cast<float>(w.x() / (2 * w.sum())), wy = static_cast<float>(w.y() / (2 * w.sum())),
             wz = static_cast<float>(w.z() / (2 * w.sum()));
  const int longest = pad.maxCoeff();
  const auto omega = static_cast<float>(2.0 / (1.0 + std::sin(std::numbers::pi / std::max(4, 2 * longest))));
  const int sweeps = std::max(20, 4 * longest);
  const auto sx = std::size_t{1};
  const auto sy = static_cast<std::size_t>(wide.size.x());
  const auto sz = sy * static_cast<std::size_t>(wide.size.y());
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int colour = 0; colour < 2; ++colour)
      parallelChunks(
          static_cast<std::size_t>(std::max(0, wide.size.z() - 2)), 4, [&](std::size_t begin, std::size_t end) {
            for (int k = static_cast<int>(begin) + 1; k < static_cast<int>(end) + 1; ++k)
              for (int j = 1; j + 1 < wide.size.y(); ++j)
                for (int i = 1 + (j + k + colour) % 2; i + 1 < wide.size.x(); i += 2) {
                  const std::size_t at = wide.linear(i, j, k);
                  if (known.values[at]) continue;
                  const auto& v = out.values;
                  const Eigen::Vector3f mean =
                      wx * (v[at - sx] + v[at + sx]) + wy * (v[at - sy] + v[at + sy]) + wz * (v[at - sz] + v[at + sz]);
                  out.values[at] += omega * (mean - out.values[at]);
                }
          });
  return out;
}

}  // namespace glisson::image
