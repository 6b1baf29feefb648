// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/rigid_bar.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/error.h"
#include "render/colour_map.h"

namespace glisson::render {
namespace {

constexpr Rgb bareLiver{128, 96, 88};
constexpr double shown = 0.03;  ///< of the scale: less is no contact that can be told from none

Rgb mixed(Rgb a, Rgb b, double t) {
  const auto one = [t](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + t * (y - x)));
  };
  return {one(a.r, b.r), one(a.g, b.g), one(a.b, b.b)};
}

/// Rings of a tube round a line, then of its two round ends; each ring a centre, a radius and two axes.
struct Ring {
  Eigen::Vector3d centre, e1, e2;
  double radius;
};

std::vector<Ring> ringsOf(const std::vector<Eigen::Vector3d>& line, double radius) {
  constexpr int cap = 12;
  std::vector<Ring> rings;
  Eigen::Vector3d e1 = (line[1] - line[0]).normalized().unitOrthogonal();
  const auto frame = [&](const Eigen::Vector3d& along) {
    e1 = (e1 - e1.dot(along) * along).normalized();  // no twist from ring to ring
    return Eigen::Vector3d(along.cross(e1));
  };
  const Eigen::Vector3d first = (line[1] - line[0]).normalized(),
                        last = (line.back() - line[line.size() - 2]).normalized();
  for (int s = 0; s < cap; ++s) {
    const double theta = 0.5 * std::numbers::pi * s / cap;
    const Eigen::Vector3d e2 = frame(first);
    rings.push_back({line.front() - radius * std::cos(theta) * first, e1, e2, radius * std::sin(theta)});
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d before = i > 0 ? (line[i] - line[i - 1]).normalized() : first;
    const Eigen::Vector3d after = i + 1 < line.size() ? (line[i + 1] - line[i]).normalized() : last;
    const Eigen::Vector3d e2 = frame((before + after).normalized());
    rings.push_back({line[i], e1, e2, radius});
  }
  for (int s = 1; s <= cap; ++s) {
    const double theta = 0.5 * std::numbers::pi * s / cap;
    const Eigen::Vector3d e2 = frame(last);
    rings.push_back({line.back() + radius * std::sin(theta) * last, e1, e2, radius * std::cos(theta)});
  }
  return rings;
}

}  // namespace

anatomy::TriangleMesh movedSurface(const RigidBar& bar, const BarContact& contact, double t) {
  anatomy::TriangleMesh moved = bar.surface;
  if (contact.u_mm.cols() == moved.vertices_lps_mm.cols()) moved.vertices_lps_mm += t * contact.u_mm.cast<double>();
  return moved;
}

std::vector<Eigen::Vector3d> movedLine(const std::vector<Eigen::Vector3d>& line, const Eigen::Vector3d& by) {
  std::vector<Eigen::Vector3d> moved = line;
  for (Eigen::Vector3d& p : moved) p += by;
  return moved;
}

anatomy::TriangleMesh barMesh(const std::vector<Eigen::Vector3d>& line, double radius) {
  if (line.size() < 2) throw BadArgument("barMesh: the centre line has fewer than two points");
  for (std::size_t i = 1; i < line.size(); ++i)
    if (!((line[i] - line[i - 1]).norm() > 0.0))
      throw BadArgument("barMesh: a point of the centre line is there twice");
  constexpr int around = 48;
  const std::vector<Ring> rings = ringsOf(line, radius);
  anatomy::TriangleMesh mesh;
  const auto count = static_cast<int>(rings.size());
  mesh.vertices_lps_mm.resize(3, count * around);
  mesh.triangles.resize(3, 2 * (count - 1) * around);
  Eigen::Index column = 0;
  for (int s = 0; s < count; ++s) {
    const Ring& ring = rings[static_cast<std::size_t>(s)];
    for (int n = 0; n < around; ++n) {
      const double phi = 2.0 * std::numbers::pi * n / around;
      mesh.vertices_lps_mm.col(s * around + n) =
          ring.centre + ring.radius * (std::cos(phi) * ring.e1 + std::sin(phi) * ring.e2);
      if (s + 1 == count) continue;
      const int a = s * around + n, b = s * around + (n + 1) % around;
      mesh.triangles.col(column++) = Eigen::Vector3i(a, b, a + around);
      mesh.triangles.col(column++) = Eigen::Vector3i(b, b + around, a + around);
    }
  }
  return mesh;
}

double pressureScale_kPa(const RigidBar& bar) {
  constexpr double share = 0.98;
  double most = 0.0;
  for (const BarContact* c : {&bar.mre, bar.atlas ? &*bar.atlas : nullptr}) {
    if (c == nullptr) continue;
    std::vector<float> pressed;
    std::copy_if(c->pressure_kPa.begin(), c->pressure_kPa.end(), std::back_inserter(pressed),
                 [](float p) { return p > 0; });
    if (pressed.empty()) continue;
    const auto at = pressed.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(pressed.size()));
    std::nth_element(pressed.begin(), at, pressed.end());
    most = std::max(most, static_cast<double>(*at));
  }
  return scaleEnd(most);
}

double largestPressure_kPa(const RigidBar& bar) {
  float most = 0.0F;
  for (const BarContact* c : {&bar.mre, bar.atlas ? &*bar.atlas : nullptr})
    if (c != nullptr && c->pressure_kPa.size() > 0) most = std::max(most, c->pressure_kPa.maxCoeff());
  return static_cast<double>(most);
}

Rgb pressureColour(double fraction) {
  const double f = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  return mixed(bareLiver, ColourMap::magma().at(0.25 + 0.75 * f), std::min(1.0, f / shown));
}

std::vector<Rgb> pressureColours(const BarContact& contact, double scale_kPa) {
  std::vector<Rgb> colours;
  colours.reserve(static_cast<std::size_t>(contact.pressure_kPa.size()));
  for (const float p : contact.pressure_kPa) colours.push_back(pressureColour(static_cast<double>(p) / scale_kPa));
  return colours;
}

}  // namespace glisson::render
