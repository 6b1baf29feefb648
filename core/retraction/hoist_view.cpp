// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/hoist_view.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace glisson::retraction {
namespace {

/// Where a line of sight meets the surface.
struct Crossing {
  double depth_mm;
  int turn;  ///< +1: enters the body, −1: leaves it
};

/// From the first crossing to where the body ends for the first time.
HoistView::Ray firstStretch(std::vector<Crossing>& crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.depth_mm != b.depth_mm ? a.depth_mm < b.depth_mm : a.turn > b.turn;
  });
  int depth = 0;
  for (const Crossing& c : crossings)
    if ((depth += c.turn) <= 0) return {crossings.front().depth_mm, c.depth_mm - crossings.front().depth_mm};
  return {crossings.front().depth_mm, crossings.back().depth_mm - crossings.front().depth_mm};
}

}  // namespace

HoistFrame::HoistFrame(const Eigen::Vector3d& direction) : hoist(direction.normalized()) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), anterior = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d wanted = std::abs(hoist.z()) < 0.95 ? z : anterior;
  up = (wanted - wanted.dot(hoist) * hoist).normalized();
  aside = up.cross(hoist);
  if (aside.x() < 0.0) aside = -aside;
}

HoistView::HoistView(const mechanics::TriangleSurface& surface, const HoistFrame& frame) : frame_(frame) {
  if (surface.triangles.empty()) throw BadArgument("HoistView: the surface has no triangle");
  std::vector<Eigen::Vector3d> seen;  // aside, up, hoist
  seen.reserve(surface.vertices.size());
  low_mm_.setConstant(std::numeric_limits<double>::infinity());
  high_mm_ = -low_mm_;
  for (const Eigen::Vector3d& v : surface.vertices) {
    seen.emplace_back(v.dot(frame.aside), v.dot(frame.up), v.dot(frame.hoist));
    low_mm_ = low_mm_.cwiseMin(seen.back().head<2>());
    high_mm_ = high_mm_.cwiseMax(seen.back().head<2>());
  }
  size_ = (high_mm_ - low_mm_).array().ceil().cast<int>().max(1);
  const auto pixels = static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y());
  std::vector<std::vector<Crossing>> crossings(pixels);
  for (const auto& t : surface.triangles) {
    std::array<Eigen::Vector3d, 3> c;
    for (std::size_t a = 0; a < 3; ++a) c[a] = seen[static_cast<std::size_t>(t[a])];
    const Eigen::Vector2d e = (c[1] - c[0]).head<2>(), f = (c[2] - c[0]).head<2>();
    const double twice = e.x() * f.y() - e.y() * f.x();
    if (std::abs(twice) < 1e-12) continue;
    auto pixel = [&](double v, int axis) { return static_cast<int>(std::floor(v - low_mm_[axis])); };
    const auto [left, right] = std::minmax({c[0].x(), c[1].x(), c[2].x()});
    const auto [bottom, top] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
    for (int j = std::max(0, pixel(bottom, 1)); j <= std::min(size_.y() - 1, pixel(top, 1)); ++j)
      for (int i = std::max(0, pixel(left, 0)); i <= std::min(size_.x() - 1, pixel(right, 0)); ++i) {
        const Eigen::Vector2d p = low_mm_ + Eigen::Vector2d(i + 0.5, j + 0.5) - c[0].head<2>();
        const double u = (p.x() * f.y() - p.y() * f.x()) / twice, v = (e.x() * p.y() - e.y() * p.x()) / twice;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const std::size_t at =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(size_.x()) + static_cast<std::size_t>(i);
        const double depth = c[0].z() + u * (c[1].z() - c[0].z()) + v * (c[2].z() - c[0].z());
        crossings[at].push_back({depth, 0});
        crossings[at].back().turn = twice < 0.0 ? 1 : -1;
      }
  }
  // Seen from behind, (aside, up, hoist) may be left-handed; then the sense of the triangles is the other one.
  const int sense = frame.aside.cross(frame.up).dot(frame.hoist) > 0.0 ? 1 : -1;
  depth_mm_.assign(pixels, 0.0f);
  thickness_mm_.assign(pixels, -1.0f);
  for (std::size_t at = 0; at < pixels; ++at) {
    if (crossings[at].empty()) continue;
    for (Crossing& c : crossings[at]) c.turn *= sense;
    const Ray first = firstStretch(crossings[at]);
    depth_mm_[at] = static_cast<float>(first.depth_mm);
    thickness_mm_[at] = static_cast<float>(first.thickness_mm);
  }
}

std::optional<HoistView::Ray> HoistView::ray(const Eigen::Vector2d& at_mm) const {
  const Eigen::Vector2i p = (at_mm - low_mm_).array().floor().cast<int>();
  if ((p.array() < 0).any() || (p.array() >= size_.array()).any()) return std::nullopt;
  const std::size_t at =
      static_cast<std::size_t>(p.y()) * static_cast<std::size_t>(size_.x()) + static_cast<std::size_t>(p.x());
  if (thickness_mm_[at] < 0.0f) return std::nullopt;
  return Ray{static_cast<double>(depth_mm_[at]), static_cast<double>(thickness_mm_[at])};
}

BarView HoistView::bar(const Eigen::Vector2d& at_mm, double angle_rad, double length_mm, double diameter_mm) const {
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad)), across(-along.y(), along.x());
  const int columns = std::max(1, static_cast<int>(std::lround(length_mm)));
  const double step_mm = length_mm / columns;
  constexpr int rows = 5;
  BarView view;
  int hits = 0;
  // Least squares of depth over (1, along, across).
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = 0; i < columns; ++i) {
    const double a = (i + 0.5) * step_mm - 0.5 * length_mm;
    int here = 0;
    for (int r = 0; r < rows; ++r) {
      const double b = diameter_mm * ((r + 0.5) / rows - 0.5);
      const auto met = ray(at_mm + a * along + b * across);
      if (!met) continue;
      ++here;
      view.thickness_mm += met->thickness_mm;
      const Eigen::Vector3d row(1.0, a, b);
      normal += row * row.transpose();
      right += met->depth_mm * row;
    }
    if (2 * here > rows) view.covered_mm += step_mm;
    hits += here;
  }
  if (hits == 0) return view;
  view.thickness_mm /= hits;
  if (hits >= 3 * rows) {
    const Eigen::Vector3d fit = normal.ldlt().solve(right);
    view.slope = fit[1];
    view.tilt = fit[2];
  }
  return view;
}

}  // namespace glisson::retraction
