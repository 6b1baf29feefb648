// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/arrows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/sampling.h"

namespace glisson::render {

namespace {

/// Multiples of the spacing inside [low, high].
std::pair<int, int> multiples(double low, double high, double spacing_mm) {
  return {static_cast<int>(std::ceil(low / spacing_mm)), static_cast<int>(std::floor(high / spacing_mm))};
}

}  // namespace

std::vector<DisplacementArrow> displacementArrows(const RetractionScene& scene, double spacing_mm, int most,
                                                  int slice) {
  if (!(spacing_mm > 0.0) || most < 1) throw BadArgument("arrows need a positive spacing and room for one at least");
  const image::ScalarVolume liver = asScalar(scene.liver);
  const LpsToIndex toLiver(liver.grid), toMre(scene.u_mre_mm.grid), toAtlas(scene.u_atlas_mm.grid);
  const image::Grid& mri = scene.mri.grid;
  std::vector<DisplacementArrow> arrows;
  const auto add = [&](const Eigen::Vector3d& p) {
    if (sampleLinear(liver, toLiver(p)) < 0.5F) return;
    arrows.push_back({p, p + sampleLinear(scene.u_mre_mm, toMre(p)).cast<double>(),
                      p + sampleLinear(scene.u_atlas_mm, toAtlas(p)).cast<double>()});
  };
  for (double step = spacing_mm;; step *= 1.25) {
    arrows.clear();
    if (slice >= 0) {
      const Eigen::Vector3d right = mri.direction.col(0), down = mri.direction.col(1), normal = mri.direction.col(2);
      const Eigen::Vector3d corner = mri.indexToLps({-0.5, -0.5, 1.0 * slice});
      const Eigen::Vector2d extent_mm(mri.size.x() * mri.spacing_mm.x(), mri.size.y() * mri.spacing_mm.y());
      for (double y = 0.5 * step; y < extent_mm.y(); y += step)
        for (double x = 0.5 * step; x < extent_mm.x(); x += step) add(corner + x * right + y * down);
      for (DisplacementArrow& a : arrows)
        for (Eigen::Vector3d* end : {&a.mre, &a.atlas}) *end -= (*end - a.rest).dot(normal) * normal;
    } else {
      Eigen::AlignedBox3d box;
      for (int n = 0; n < 8; ++n)
        box.extend(liver.grid.indexToLps(Eigen::Vector3d(n & 1 ? liver.grid.size.x() - 0.5 : -0.5,
                                                         n & 2 ? liver.grid.size.y() - 0.5 : -0.5,
                                                         n & 4 ? liver.grid.size.z() - 0.5 : -0.5)));
      const auto [i0, i1] = multiples(box.min().x(), box.max().x(), step);
      const auto [j0, j1] = multiples(box.min().y(), box.max().y(), step);
      const auto [k0, k1] = multiples(box.min().z(), box.max().z(), step);
      for (int k = k0; k <= k1; ++k)
        for (int j = j0; j <= j1; ++j)
          for (int i = i0; i <= i1; ++i) add(step * Eigen::Vector3d(i, j, k));
    }
    if (arrows.size() <= static_cast<std::size_t>(most)) return arrows;
  }
}

}  // namespace glisson::render
