// SPDX-License-Identifier: GPL-3.0-or-later

// What the pictures show of a rigid bar: surface, displacement and pressure on it, and the way of the bar.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "pipeline/detail/outputs.h"

namespace glisson::pipeline::detail {
namespace {

constexpr double surface_mm = 2.5;                 ///< edge of the cubes that the drawn surface is made on
constexpr double reach_mm = 3.0, sigma_mm = 1.25;  ///< of a sample of contact; samples lie at most 1.5 mm apart

/// Samples of a surface, to be asked at any place on it: means of those within 3 mm, weighted by area and a Gaussian;
/// of the nearest where there is none.
class Samples {
 public:
  explicit Samples(const retraction::RigidContact& contact) : c_(contact) {
    for (std::size_t i = 0; i < c_.sample_mm.size(); ++i) cubes_[keyOf(cubeOf(c_.sample_mm[i]))].push_back(i);
  }

  struct Value {
    Eigen::Vector3d u_mm = Eigen::Vector3d::Zero();
    double pressure_kPa = 0.0;
  };
  Value at(const Eigen::Vector3d& p_mm) const {
    Value mean;
    double weight = 0.0;
    forCubes(cubeOf(p_mm), 1, [&](std::size_t i) {
      const double square = (c_.sample_mm[i] - p_mm).squaredNorm();
      if (square > reach_mm * reach_mm) return;
      const double w = c_.sample_mm2[i] * std::exp(-0.5 * square / (sigma_mm * sigma_mm));
      mean.u_mm += w * c_.sample_u_mm[i];
      mean.pressure_kPa += w * c_.pressure_kPa[i];
      weight += w;
    });
    if (!(weight > 0.0)) return nearest(p_mm);
    return {mean.u_mm / weight, mean.pressure_kPa / weight};
  }

 private:
  static Eigen::Vector3i cubeOf(const Eigen::Vector3d& p_mm) { return (p_mm / reach_mm).array().floor().cast<int>(); }
  static std::int64_t keyOf(const Eigen::Vector3i& cube) {
    const auto part = [](int v) { return static_cast<std::int64_t>(v + (1 << 20)); };
    return (part(cube.x()) << 42) | (part(cube.y()) << 21) | part(cube.z());
  }
  template <typename Visit>
  void forCubes(const Eigen::Vector3i& centre, int reach, Visit&& visit) const {
    for (int k = -reach; k <= reach; ++k)
      for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i)
          if (const auto found = cubes_.find(keyOf(centre + Eigen::Vector3i(i, j, k))); found != cubes_.end())
            for (const std::size_t sample : found->second) visit(sample);
  }
  Value nearest(const Eigen::Vector3d& p_mm) const {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (int reach = 2; reach <= 8 && !std::isfinite(least); reach *= 2)
      forCubes(cubeOf(p_mm), reach, [&](std::size_t i) {
        const double square = (c_.sample_mm[i] - p_mm).squaredNorm();
        if (square < least) {
          least = square;
          best = i;
        }
      });
    return std::isfinite(least) ? Value{c_.sample_u_mm[best], c_.pressure_kPa[best]} : Value{};
  }

  const retraction::RigidContact& c_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cubes_;
};

anatomy::TriangleMesh asMesh(const mechanics::TriangleSurface& surface) {
  anatomy::TriangleMesh mesh;
  mesh.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(surface.vertices.size()));
  mesh.triangles.resize(3, static_cast<Eigen::Index>(surface.triangles.size()));
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    mesh.vertices_lps_mm.col(static_cast<Eigen::Index>(i)) = surface.vertices[i];
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    for (int c = 0; c < 3; ++c)
      mesh.triangles(c, static_cast<Eigen::Index>(i)) = surface.triangles[i][static_cast<std::size_t>(c)];
  return mesh;
}

/// How a place that lies in the bar is to be moved onto it. Contact lets the surface 0.5 mm into the bar, and between
/// vertices the drawn surface is flat.
Eigen::Vector3d ontoBar(const retraction::RigidContact& c, const Eigen::Vector3d& p_mm) {
  constexpr double flat_mm = 0.2;  ///< a chord of the drawn surface, below its arc on a bar of 5 mm
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < c.bar_mm.size(); ++i) {
    const Eigen::Vector3d a = c.bar_mm[i - 1] + c.travel_mm * c.hoist, along = c.bar_mm[i] - c.bar_mm[i - 1];
    const Eigen::Vector3d d = p_mm - a - std::clamp((p_mm - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
    if (d.norm() < least) {
      least = d.norm();
      nearest = d;
    }
  }
  const double in_mm = c.barRadius_mm + flat_mm - least;
  return in_mm > 0.0 && least > 0.0 ? Eigen::Vector3d(in_mm / least * nearest) : Eigen::Vector3d::Zero().eval();
}

render::BarContact contactOn(const anatomy::TriangleMesh& surface, const retraction::RigidContact& c) {
  render::BarContact drawn;
  drawn.travel_mm = c.travel_mm;
  drawn.force_N = c.force_N.dot(c.hoist);
  drawn.resultant_N = c.force_N.norm();
  drawn.area_mm2 = c.area_mm2;
  drawn.capacity_N = c.capacity_N;
  drawn.capacityExceeded = c.capacityExceeded;
  drawn.slipped = c.slipped();
  drawn.path = c.path;
  const Samples samples(c);
  drawn.u_mm.resize(3, surface.vertices_lps_mm.cols());
  drawn.pressure_kPa.resize(surface.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < surface.vertices_lps_mm.cols(); ++n) {
    const Samples::Value value = samples.at(surface.vertices_lps_mm.col(n));
    const Eigen::Vector3d at = surface.vertices_lps_mm.col(n) + value.u_mm;
    drawn.u_mm.col(n) = (value.u_mm + ontoBar(c, at)).cast<float>();
    drawn.pressure_kPa[n] = static_cast<float>(value.pressure_kPa);
  }
  return drawn;
}

}  // namespace

std::optional<render::RigidBar> drawnBar(const RunResult& r, const anatomy::TriangleMesh& liver) {
  if (!r.primary.contact) return {};
  render::RigidBar bar;
  bar.centreline_lps_mm = r.primary.contact->bar_mm;
  bar.asked_N = r.primary.contact->asked_N;
  bar.surface = r.model.smooth ? asMesh(r.model.smooth->surface(surface_mm)) : liver;
  bar.mre = contactOn(bar.surface, *r.primary.contact);
  if (r.atlas && r.atlas->contact) bar.atlas = contactOn(bar.surface, *r.atlas->contact);
  return bar;
}

}  // namespace glisson::pipeline::detail
