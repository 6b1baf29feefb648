// SPDX-License-Identifier: GPL-3.0-or-later

// A soft lobe on a rigid bar: poses, stiffnesses, Poisson's ratios, with and without capsule. Each place bears the
// weight or the bar slips, and the largest force is said.
#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/contact_solve.h"
#include "mechanics/contact/follower_loads.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;

constexpr double cell_mm = 6.56, weight_N = 15.9;
constexpr double bed_Pa_m = 1e5 * 1e3;  ///< 0.1 kPa/mm
constexpr int poses = 12;
const Vector3d half_mm(95, 75, 60);  ///< semi-axes of the lobe

/// Points of the ellipsoid's surface with normals and areas, about a millimetre apart.
std::vector<mechanics::SurfaceSample> ellipsoid() {
  constexpr int rings = 260;
  std::vector<mechanics::SurfaceSample> samples;
  for (int a = 0; a < rings; ++a) {
    const double theta = std::numbers::pi * (a + 0.5) / rings;
    const int count = std::max(8, static_cast<int>(2 * rings * std::sin(theta)));
    for (int b = 0; b < count; ++b) {
      const double phi = 2 * std::numbers::pi * (b + 0.5) / count;
      const Vector3d e(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      const Vector3d normal = e.cwiseQuotient(half_mm);
      const double area_mm2 = half_mm.prod() * normal.norm() * std::sin(theta) * (std::numbers::pi / rings) *
                              (2 * std::numbers::pi / count);
      samples.push_back({1e-3 * (half_mm + e.cwiseProduct(half_mm)), normal.normalized(), 1e-6 * area_mm2});
    }
  }
  return samples;
}

/// Covered fraction of each cell, by 4 × 4 × 4 points; below a tenth it is no cell.
std::vector<double> covered(const Eigen::Vector3i& cells) {
  std::vector<double> fraction;
  for (int k = 0; k < cells.z(); ++k)
    for (int j = 0; j < cells.y(); ++j)
      for (int i = 0; i < cells.x(); ++i) {
        int inside = 0;
        for (int t = 0; t < 64; ++t) {
          const Vector3d p =
              Vector3d(i + (t % 4 + 0.5) / 4, j + (t / 4 % 4 + 0.5) / 4, k + (t / 16 + 0.5) / 4) * cell_mm;
          inside += (p - half_mm).cwiseQuotient(half_mm).squaredNorm() < 1 ? 1 : 0;
        }
        fraction.push_back(inside < 7 ? 0.0 : inside / 64.0);
      }
  return fraction;
}

/// The lobe on its bed (far from the bar, behind and above), without the bar.
mechanics::ContactProblem lobe(double shear_kPa, double poisson, double capsule_N_m) {
  mechanics::ContactProblem p;
  mechanics::VoxelBody& body = p.problem.body;
  body.cells = (2 * half_mm / cell_mm).array().ceil().cast<int>();
  body.h_m = Vector3d::Constant(1e-3 * cell_mm);
  body.poisson = poisson;
  body.E_Pa = covered(body.cells);
  for (double& E : body.E_Pa) E *= 2e3 * shear_kPa * (1 + poisson);
  p.surface = ellipsoid();
  const mechanics::VoxelMesh mesh(body);
  p.problem.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  std::map<int, double> stiffness_N_m;
  if (capsule_N_m > 0) p.rind_Pa = mechanics::rindOf(body, p.surface, capsule_N_m, 3e-3);
  for (const mechanics::SurfaceSample& s : p.surface) {
    const double seen = std::max(0.0, s.normal.y()) + std::max(0.0, s.normal.z());
    for (const auto& [node, share] : mechanics::sharesOf(mesh, s.p_m))
      stiffness_N_m[node] += share * seen * s.area_m2 * bed_Pa_m;
  }
  for (const auto& [node, k] : stiffness_N_m)
    if (k > 0) p.problem.supports.springs.push_back({node, k * Eigen::Matrix3d::Identity()});
  return p;
}

/// Three places along the lobe, on its middle and below, hoisted straight and 30 degrees aslant.
mechanics::RigidBar barAt(int pose) {
  constexpr std::array<double, 3> x_mm = {60, 95, 130};
  const double z_mm = pose / 3 % 2 == 0 ? 45 : 60, angle = pose < 6 ? 0.0 : std::numbers::pi / 6;
  const Vector3d hoist(0, std::cos(angle), std::sin(angle) * (z_mm < 55 ? 1 : -1));
  const Vector3d centre = 1e-3 * Vector3d(x_mm[static_cast<std::size_t>(pose % 3)], -40, z_mm) - 0.06 * hoist;
  const Vector3d half(0.04, 0, 0);
  return {{centre - half, centre + half}, 0.005, hoist};
}

Outcome hoisted(double shear_kPa, double poisson, double capsule_N_m, int step, const Progress& progress) {
  mechanics::ContactProblem p = lobe(shear_kPa, poisson, capsule_N_m);
  p.force_N = weight_N;
  Outcome o;
  int borne = 0, slipped = 0, tried = 0;
  double least_N = weight_N, most_N = 0, longest_mm = 0;
  for (int pose = 0; pose < poses; pose += step, ++tried) {
    p.bar = barAt(pose);
    const mechanics::ContactSolution s =
        mechanics::solveContact(p, {}, progress.part(1.0 * pose / poses, (pose + 1.0 * step) / poses));
    if (s.outcome == mechanics::ContactOutcome::Reached && s.solution.report.converged()) {
      ++borne;
      o.add(s.solution.report);
      longest_mm = std::max(longest_mm, 1e3 * s.travel_m);
    } else if (s.outcome == mechanics::ContactOutcome::Slips) {
      ++slipped;
      least_N = std::min(least_N, s.capacity_N);
      most_N = std::max(most_N, s.capacity_N);
    }
  }
  o.good = borne + slipped == tried;
  o.detail = words(borne, " of ", tried, " places bear the weight, after ", longest_mm, " mm at most");
  if (slipped > 0) o.detail += words("; ", slipped, " slip, at ", least_N, " to ", most_N, " N");
  if (!o.good) o.detail += words("; ", tried - borne - slipped, " without an answer");
  return o;
}

}  // namespace

Scenes contactScenes(const StabilityOptions& options) {
  Scenes s;
  const std::vector<double> shears =
      options.quick ? std::vector<double>{2.1, 8.0} : std::vector<double>{1.0, 2.1, 5.8, 8.0};
  const std::vector<double> ratios = options.quick ? std::vector<double>{0.45} : std::vector<double>{0.3, 0.45, 0.49};
  for (const double capsule : {250.0, 0.0})
    for (const double ratio : ratios)
      for (const double shear : shears) {
        if (options.quick && capsule == 0.0) continue;
        s.push_back({words("bar under a lobe, shear modulus ", shear, " kPa, Poisson's ratio ", ratio,
                           capsule > 0 ? ", with capsule" : ", without capsule"),
                     "every place bears the weight, or the bar slips and its largest force is said",
                     [=, step = options.quick ? 3 : 1](const Progress& progress) {
                       return hoisted(shear, ratio, capsule, step, progress);
                     }});
      }
  return s;
}

}  // namespace glisson::study
