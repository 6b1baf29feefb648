// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "render/overlay.h"

namespace glisson::test {

/// A scene on any grid from closed forms: what is liver, how bright a point is, where it goes.
struct SceneForms {
  std::function<bool(const Eigen::Vector3d&)> inLiver;
  std::function<float(const Eigen::Vector3d&)> brightness;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> u_mre_mm;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> u_atlas_mm;
};

/// Fields are zero outside the liver, as a simulation gives them.
inline render::RetractionScene sceneFrom(const image::Grid& grid, const SceneForms& forms) {
  render::RetractionScene scene;
  scene.mri = image::ScalarVolume(grid);
  scene.liver = image::Mask(grid);
  scene.u_mre_mm = image::DisplacementField(grid, Eigen::Vector3f::Zero());
  scene.u_atlas_mm = scene.u_mre_mm;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const Eigen::Vector3d p = grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>());
        const std::size_t n = grid.linear(i, j, k);
        scene.mri.values[n] = forms.brightness(p);
        if (!forms.inLiver(p)) continue;
        scene.liver.values[n] = 1;
        scene.u_mre_mm.values[n] = forms.u_mre_mm(p).cast<float>();
        scene.u_atlas_mm.values[n] = forms.u_atlas_mm(p).cast<float>();
      }
  return scene;
}

/// A tube of circular cross-section whose radius goes linearly from one end to the other, appended to mesh.
inline void appendTube(anatomy::TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radiusA,
                       double radiusB) {
  constexpr int around = 20, along = 16;
  const Eigen::Vector3d axis = (b - a).normalized();
  const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  const auto first = static_cast<int>(mesh.vertices_lps_mm.cols());
  mesh.vertices_lps_mm.conservativeResize(3, first + around * (along + 1));
  for (int s = 0; s <= along; ++s)
    for (int n = 0; n < around; ++n) {
      const double t = static_cast<double>(s) / along, angle = 2.0 * 3.14159265358979 * n / around;
      mesh.vertices_lps_mm.col(first + s * around + n) =
          a + t * (b - a) + ((1 - t) * radiusA + t * radiusB) * (std::cos(angle) * e1 + std::sin(angle) * e2);
    }
  auto column = mesh.triangles.cols();
  mesh.triangles.conservativeResize(3, column + 2 * around * along);
  for (int s = 0; s < along; ++s)
    for (int n = 0; n < around; ++n) {
      const int v00 = first + s * around + n, v01 = first + s * around + (n + 1) % around;
      mesh.triangles.col(column++) = Eigen::Vector3i(v00, v01, v00 + around);
      mesh.triangles.col(column++) = Eigen::Vector3i(v01, v01 + around, v00 + around);
    }
}

/// A liver-sized ellipsoid (r² + 0.18 x = 1 in its radii) with a branching vessel tree, in a body with fat and spine.
struct SyntheticLiver {
  struct Tube {
    Eigen::Vector3d a, b;
    double ra, rb;
  };
  Eigen::Vector3d centre{-45.0, 5.0, 0.0}, radii{80.0, 52.0, 62.0};
  Eigen::Vector3d contact{-85.0, -12.0, -48.0};  ///< of the retractor, under the inferior right lobe
  std::vector<Tube> tubes{{{-10, 10, -25}, {-40, 5, -5}, 6.5, 5.5},   {{-40, 5, -5}, {-80, 10, -15}, 5.0, 3.5},
                          {{-40, 5, -5}, {-30, -15, 20}, 4.5, 3.0},   {{-80, 10, -15}, {-105, 0, -30}, 3.2, 1.8},
                          {{-80, 10, -15}, {-100, 25, 5}, 3.0, 1.8},  {{-30, -15, 20}, {-10, -25, 35}, 2.8, 1.6},
                          {{-30, -15, 20}, {-55, -25, 30}, 2.6, 1.6}, {{-80, 10, -15}, {-90, -5, -40}, 3.0, 1.8},
                          {{-40, 5, -5}, {-62, 20, 25}, 4.0, 2.5},    {{-62, 20, 25}, {-90, 22, 30}, 2.4, 1.4}};

  bool holds(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = (p - centre).cwiseQuotient(radii);
    return q.squaredNorm() + 0.18 * q.x() < 1.0;
  }

  /// Displacement by the hoist at the contact.
  Eigen::Vector3d hoisted_mm(const Eigen::Vector3d& p, double scale) const {
    const double r = (p - contact).norm();
    const double near = std::exp(-r * r / (2.0 * 42.0 * 42.0));
    return scale * (near * Eigen::Vector3d(5.0, -17.0, 4.0) + Eigen::Vector3d(0.4, -1.2, 0.3));
  }

  float brightness(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d body = (p - Eigen::Vector3d(-30, 10, 0)).cwiseQuotient(Eigen::Vector3d(128, 84, 400));
    if (body.squaredNorm() > 1.0) return 0.0F;
    if (body.squaredNorm() > 0.88) return 330.0F;  // fat
    if (!holds(p)) {
      const double spine = (p - Eigen::Vector3d(5, 68, p.z())).norm();
      return spine < 18.0 ? 210.0F : static_cast<float>(90.0 + 25.0 * std::sin(p.x() / 9.0) * std::cos(p.y() / 7.0));
    }
    for (const Tube& t : tubes) {
      const double s = std::clamp((p - t.a).dot(t.b - t.a) / (t.b - t.a).squaredNorm(), 0.0, 1.0);
      if ((p - t.a - s * (t.b - t.a)).norm() < (1 - s) * t.ra + s * t.rb) return 340.0F;
    }
    return static_cast<float>(200.0 + 6.0 * std::sin(p.x() / 5.0) * std::sin(p.y() / 4.0 + p.z() / 6.0));
  }

  anatomy::TriangleMesh surface() const {
    constexpr int meridians = 64, parallels = 40;
    anatomy::TriangleMesh mesh;
    mesh.vertices_lps_mm.resize(3, meridians * (parallels + 1));
    mesh.triangles.resize(3, 2 * meridians * parallels);
    for (int s = 0; s <= parallels; ++s)
      for (int n = 0; n < meridians; ++n) {
        const double theta = 3.14159265358979 * s / parallels, phi = 2.0 * 3.14159265358979 * n / meridians;
        const Eigen::Vector3d d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        const double b = 0.18 * d.x();  // r² + b r = 1 on the surface
        mesh.vertices_lps_mm.col(s * meridians + n) =
            centre + (0.5 * (-b + std::sqrt(b * b + 4.0)) * d).cwiseProduct(radii);
      }
    int column = 0;
    for (int s = 0; s < parallels; ++s)
      for (int n = 0; n < meridians; ++n) {
        const int a = s * meridians + n, b = s * meridians + (n + 1) % meridians;
        mesh.triangles.col(column++) = Eigen::Vector3i(a, a + meridians, b);
        mesh.triangles.col(column++) = Eigen::Vector3i(b, a + meridians, b + meridians);
      }
    return mesh;
  }
};

/// The synthetic liver, hoisted; the MRE state moves further than the atlas state (a softer organ) or less, by scale.
inline render::RetractionScene retractionScene(double mreOverAtlas, int inPlane = 128) {
  image::Grid grid;
  const double spacing = 210.0 / inPlane;
  grid.size = {inPlane, inPlane * 4 / 5, 40};
  grid.spacing_mm = {spacing, spacing, 4.0};
  grid.origin_lps_mm = {-135.0, -75.0, -80.0};
  const SyntheticLiver liver;
  render::RetractionScene scene =
      sceneFrom(grid, {.inLiver = [&](const Eigen::Vector3d& p) { return liver.holds(p); },
                       .brightness = [&](const Eigen::Vector3d& p) { return liver.brightness(p); },
                       .u_mre_mm = [&](const Eigen::Vector3d& p) { return liver.hoisted_mm(p, mreOverAtlas); },
                       .u_atlas_mm = [&](const Eigen::Vector3d& p) { return liver.hoisted_mm(p, 1.0); }});
  for (const auto& t : liver.tubes) appendTube(scene.vesselSurface, t.a, t.b, t.ra, t.rb);
  scene.liverSurface = liver.surface();
  scene.retractorPoint_lps_mm = liver.contact;
  scene.retractorAxis = Eigen::Vector3d(1.0, 0.1, 0.0).normalized();
  scene.caption = "Synthetic liver. Mesh-free, 200 frames, linear; hoisting force = liver weight, transverse plane.";
  return scene;
}

}  // namespace glisson::test
