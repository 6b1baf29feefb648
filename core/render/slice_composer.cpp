// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/slice_composer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "base/parallel.h"
#include "render/painter.h"
#include "render/slice_frame.h"
#include "render/stroke_cover.h"
#include "render/surface_cut.h"

namespace glisson::render::detail {
namespace {

constexpr float dimmed = 0.45F;  // tissue outside the liver, not simulated

/// The voxels of a grid, from the first to the last along each axis, that the tri-linear mask may reach; empty (last
/// before first) where there are none.
std::pair<Eigen::Vector3i, Eigen::Vector3i> reachOf(const image::ScalarVolume& mask, const image::Grid& grid) {
  Eigen::AlignedBox3d box;
  std::size_t n = 0;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i, ++n)
        if (mask.values[n] > 0.0F) box.extend(Eigen::Vector3d(i, j, k));
  if (box.isEmpty()) return {Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(-1)};
  const Eigen::AlignedBox3d wide(box.min().array() - 1.0, box.max().array() + 1.0);
  Eigen::AlignedBox3d reach;
  for (int c = 0; c < 8; ++c)
    reach.extend(grid.lpsToIndex(mask.grid.indexToLps(wide.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)))));
  const Eigen::Vector3d last = (grid.size - Eigen::Vector3i::Ones()).cast<double>();
  const auto within = [&](const Eigen::Vector3d& index) {
    return Eigen::Vector3d(index.cwiseMax(-1.0).cwiseMin(last + Eigen::Vector3d::Ones()));
  };
  return {within(reach.min()).array().floor().cast<int>().max(0),
          within(reach.max()).array().ceil().cast<int>().min(grid.size.array() - 1)};
}

Window windowOf(const image::ScalarVolume& mri, const image::ScalarVolume& liver) {
  const LpsToIndex toLiver(liver.grid);
  const image::Grid& grid = mri.grid;
  const auto [first, last] = reachOf(liver, grid);
  std::vector<float> inside;
  for (int k = first.z(); k <= last.z(); ++k)
    for (int j = first.y(); j <= last.y(); ++j)
      for (int i = first.x(); i <= last.x(); ++i)
        if (sampleLinear(liver, toLiver(grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>()))) >= 0.5F &&
            std::isfinite(mri.at(i, j, k)))
          inside.push_back(mri.at(i, j, k));
  if (inside.empty())
    throw BadInput("the liver mask and the MRI do not overlap: check that both lie in the same frame of reference");
  const auto percentile = [&](double p) {
    const auto n = static_cast<std::ptrdiff_t>(p * static_cast<double>(inside.size() - 1));
    std::nth_element(inside.begin(), inside.begin() + n, inside.end());
    return inside[static_cast<std::size_t>(n)];
  };
  const float p1 = percentile(0.01), p50 = percentile(0.5), p99 = percentile(0.995);
  // Contrast for vessels: black lies well below the darkest liver, white at its brightest percent.
  Window w{p1 - (p50 - p1) - 0.9F * (p99 - p50), p99};
  if (!(w.high - w.low > 1e-6F * std::max(1.0F, std::abs(w.high))))
    w = {std::min(0.0F, w.high), std::max(w.high, 0.0F)};
  if (!(w.high > w.low)) w.high = w.low + 1.0F;
  return w;
}

/// Both fields carried on beyond the liver, side by side.
std::array<image::DisplacementField, 2> carriedOn(const RetractionScene& scene, const image::ScalarVolume& liver) {
  const std::array<const image::DisplacementField*, 2> fields{&scene.u_mre_mm, &scene.u_atlas_mm};
  const double reach_mm = std::max(largestDisplacement_mm(*fields[0]), largestDisplacement_mm(*fields[1])) +
                          3.0 * liver.grid.spacing_mm.maxCoeff();
  std::array<image::DisplacementField, 2> out;
  parallelChunks(fields.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) out[n] = extended(*fields[n], liver, reach_mm);
  });
  return out;
}

double outlineWidth(const SlicePlane& plane) {
  return 2.0 * std::max(0.7, std::min(plane.width, plane.height) / 900.0);
}

void line(const SlicePlane& plane, const Point& from, const Point& to, double width, float bright,
          std::vector<float>& out) {
  coverStroke(from, to, width, plane.width, plane.height, [&](int x, int y, double cover) {
    float& at = out[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
    at = std::max(at, bright * static_cast<float>(cover));
  });
}

/// The bar where the plane cuts it: even, with outlines a bright edge, so that it is told from tissue.
void barCut(const SlicePlane& plane, const anatomy::TriangleMesh& bar, bool outlines, std::vector<float>& out) {
  constexpr float steel = 0.55F;
  const SurfaceCut cut = cutSurface(plane, bar);
  for (std::size_t n = 0; n < out.size(); ++n)
    if (cut.inside[n] != 0) out[n] = steel;
  if (!outlines) return;
  for (const auto& [from, to] : cut.lines) line(plane, from, to, 1.5 * outlineWidth(plane), 1.0F, out);
}

/// A thin bright line where phi changes sign; its distance is |phi| over the gradient.
void outline(const SlicePlane& plane, const std::vector<float>& phi, std::vector<float>& out) {
  const auto at = [&](int x, int y) {
    return phi[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
  };
  const auto half = static_cast<float>(0.5 * outlineWidth(plane));
  for (int y = 1; y + 1 < plane.height; ++y)
    for (int x = 1; x + 1 < plane.width; ++x) {
      const float gx = 0.5F * (at(x + 1, y) - at(x - 1, y)), gy = 0.5F * (at(x, y + 1) - at(x, y - 1));
      const float slope = std::sqrt(gx * gx + gy * gy);
      if (slope < 1e-4F) continue;
      const float cover = std::clamp(half + 0.5F - std::abs(at(x, y)) / slope, 0.0F, 1.0F);
      float& to =
          out[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
      to = std::max(to, 0.9F * cover);
    }
}

/// Coverage of the millimetre grid, every fifth line stronger; lines lie on multiples of grid_mm in the patient frame.
std::vector<float> gridCover(const SlicePlane& plane, double grid_mm) {
  std::vector<float> cover(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height), 0.0F);
  const auto draw = [&](const Eigen::Vector3d& axis, bool vertical) {
    const double start = plane.corner_lps.dot(axis);
    const int extent = vertical ? plane.width : plane.height;
    for (const double v : gridLines_mm(start, start + extent * plane.mmPerPixel, grid_mm)) {
      const double at = (v - start) / plane.mmPerPixel;
      const bool major = std::lround(v / grid_mm) % 5 == 0;
      const double width = (major ? 1.6 : 1.0) * std::max(1.0, std::min(plane.width, plane.height) / 1000.0);
      const Point a = vertical ? Point(at, 0.0) : Point(0.0, at);
      const Point b = vertical ? Point(at, plane.height) : Point(plane.width, at);
      coverStroke(a, b, width, plane.width, plane.height, [&](int x, int y, double c) {
        float& to =
            cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
        to = std::max(to, static_cast<float>((major ? 1.0 : 0.7) * c));
      });
    }
  };
  draw(plane.right, true);
  draw(plane.down, false);
  return cover;
}

}  // namespace

MovedState::MovedState(image::DisplacementField carriedOn, const image::ScalarVolume& liver,
                       const RetractionScene& scene, bool atlas)
    : u_mm(std::move(carriedOn)), inverse(u_mm, true, liver) {
  if (!scene.bar) return;
  const BarContact& contact = atlas && scene.bar->atlas ? *scene.bar->atlas : scene.bar->mre;
  if (scene.bar->surface.triangles.cols() > 0) surface = movedSurface(*scene.bar, contact, 1.0);
  bar = barMesh(movedLine(scene.bar->centreline_lps_mm, contact.travel_mm * scene.retractorDirection.normalized()),
                0.5 * scene.retractorDiameter_mm);
}

SliceComposer::SliceComposer(const RetractionScene& scene)
    : scene_(scene),
      liver_(asScalar(scene.liver)),
      window_(windowOf(scene.mri, liver_)),
      fields_(carriedOn(scene, liver_)),
      mre_(std::move(fields_[0]), liver_, scene, false),
      atlas_(std::move(fields_[1]), liver_, scene, true) {}

Picture SliceComposer::draw(const SlicePlane& plane, const SliceOverlayOptions& options) const {
  const Palette palette = options.palette;
  const std::vector<float> atlas = channel(plane, atlas_, options.outlines),
                           mre = channel(plane, mre_, options.outlines);
  const std::vector<float> grid = gridCover(plane, options.grid_mm);
  Picture out = blankPicture(plane.width, plane.height, {0, 0, 0});
  const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F))); };
  for (std::size_t n = 0; n < atlas.size(); ++n) {
    float r = atlas[n], b = mre[n], g = grid[n];
    if (palette == Palette::ColourBlind) {  // orange (1, .55, 0) + blue (0, .45, 1): white where they agree
      const float w = 0.75F * g;
      g = (1.0F - w) * (0.55F * r + 0.45F * b) + w * 0.75F;
      r *= 1.0F - w;
      b *= 1.0F - w;
    } else {
      g *= 0.62F;
    }
    out.rgb[3 * n] = byte(r);
    out.rgb[3 * n + 1] = byte(g);
    out.rgb[3 * n + 2] = byte(b);
  }
  return out;
}

std::pair<Eigen::Vector2d, Eigen::Vector2d> SliceComposer::liverBox(const SlicePlane& plane) const {
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  const image::Grid& grid = liver_.grid;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        if (liver_.at(i, j, k) < 0.5F) continue;
        const Eigen::Vector3d p = grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>());
        for (const Eigen::Vector3d& q :
             {p, Eigen::Vector3d(p + mre_.inverse.at(p)), Eigen::Vector3d(p + atlas_.inverse.at(p))}) {
          low = low.cwiseMin(plane.toPixel(q));
          high = high.cwiseMax(plane.toPixel(q));
        }
      }
  return {low, high};
}

bool SliceComposer::showsBar(const SlicePlane& plane) const {
  const auto cuts = [&](const MovedState& state) { return state.bar && !cutSurface(plane, *state.bar).lines.empty(); };
  return cuts(mre_) || (scene_.compared && cuts(atlas_));
}

double SliceComposer::largestSeen_mm(int k) const {
  const image::Grid& grid = scene_.mri.grid;
  const LpsToIndex toLiver(liver_.grid), toMre(scene_.u_mre_mm.grid), toAtlas(scene_.u_atlas_mm.grid);
  double largest = 0.0;
  for (int j = 0; j < grid.size.y(); ++j)
    for (int i = 0; i < grid.size.x(); ++i) {
      const InverseMap::Result rest = mre_.inverse.rest(grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>()));
      if (!rest.found || sampleLinear(liver_, toLiver(rest.x_lps)) < 0.5F) continue;
      Eigen::Vector3f d = sampleLinear(scene_.u_mre_mm, toMre(rest.x_lps));
      if (scene_.compared) d -= sampleLinear(scene_.u_atlas_mm, toAtlas(rest.x_lps));
      largest = std::max(largest, static_cast<double>(d.norm()));
    }
  return largest;
}

std::vector<float> SliceComposer::channel(const SlicePlane& plane, const MovedState& state, bool outlines) const {
  const LpsToIndex toMri(scene_.mri.grid), toLiver(liver_.grid);
  const auto width = static_cast<std::size_t>(plane.width);
  std::optional<SurfaceCut> cut;
  if (state.surface) cut = cutSurface(plane, *state.surface);
  std::vector<float> out(width * static_cast<std::size_t>(plane.height));
  std::vector<float> phi(out.size(), -1.0F);
  std::vector<std::uint8_t> unknown(out.size(), 0);
  parallelChunks(static_cast<std::size_t>(plane.height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column < width; ++column) {
        const std::size_t n = row * width + column;
        const Eigen::Vector3d y = plane.toLps(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
        const bool known = cut && cut->closed[row];
        bool liver = known && cut->inside[n] != 0;
        // Where the surface says that there is no liver, nobody asks what rests where.
        if (liver || !known) {
          const InverseMap::Result rest = state.inverse.rest(y);
          phi[n] = rest.found ? sampleLinear(liver_, toLiver(rest.x_lps)) - 0.5F : -0.5F;
          unknown[n] = liver && !rest.found;
          if (!known) liver = phi[n] >= 0.0F;
          if (liver) out[n] = window_(sampleLinear(scene_.mri, toMri(rest.x_lps)));
        }
        if (!liver && sampleLinear(liver_, toLiver(y)) < 0.5F)
          out[n] = dimmed * window_(sampleLinear(scene_.mri, toMri(y)));
      }
  });
  fillFromBeside(unknown, width, out);
  if (state.bar) barCut(plane, *state.bar, outlines, out);
  if (!outlines) return out;
  if (cut)
    for (const auto& [from, to] : cut->lines) line(plane, from, to, outlineWidth(plane), 0.9F, out);
  else
    outline(plane, phi, out);
  vesselCut(plane, state, out);
  return out;
}

void SliceComposer::vesselCut(const SlicePlane& plane, const MovedState& state, std::vector<float>& out) const {
  const anatomy::TriangleMesh& mesh = scene_.vesselSurface;
  if (mesh.triangles.cols() == 0) return;
  const Eigen::Vector3d normal = plane.normal();
  std::vector<Eigen::Vector3d> moved(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()));
  std::vector<double> height(moved.size());
  for (std::size_t n = 0; n < moved.size(); ++n) {
    const Eigen::Vector3d p = mesh.vertices_lps_mm.col(static_cast<Eigen::Index>(n));
    moved[n] = p + state.inverse.at(p);
    height[n] = (moved[n] - plane.corner_lps).dot(normal);
  }
  const double width = std::max(1.2, std::min(plane.width, plane.height) / 600.0);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    std::vector<Point> ends;
    for (int e = 0; e < 3; ++e) {
      const auto a = static_cast<std::size_t>(mesh.triangles(e, t));
      const auto b = static_cast<std::size_t>(mesh.triangles((e + 1) % 3, t));
      if ((height[a] < 0.0) == (height[b] < 0.0)) continue;
      ends.push_back(plane.toPixel(moved[a] + (moved[b] - moved[a]) * (height[a] / (height[a] - height[b]))));
    }
    if (ends.size() != 2) continue;
    line(plane, ends[0], ends[1], width, 1.0F, out);
  }
}

}  // namespace glisson::render::detail
