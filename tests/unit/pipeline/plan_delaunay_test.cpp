// SPDX-License-Identifier: GPL-3.0-or-later

// What the plan says of Delaunay tetrahedra before there are any, against those that are made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "image/io.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "support/support.h"

namespace glisson::pipeline {
namespace {

image::Mask ellipsoid(const Eigen::Vector3d& semi_mm) {
  image::Grid g;
  g.spacing_mm = {2.0, 2.0, 3.0};
  for (int a = 0; a < 3; ++a) g.size[a] = 2 * static_cast<int>(std::ceil(semi_mm[a] / g.spacing_mm[a])) + 2;
  g.origin_lps_mm = -0.5 * g.spacing_mm.cwiseProduct((g.size.cast<double>().array() - 1.0).matrix());
  image::Mask mask(g);
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i)
        mask.at(i, j, k) = g.indexToLps(Eigen::Vector3d(i, j, k)).cwiseQuotient(semi_mm).norm() < 1 ? 1 : 0;
  return mask;
}

struct Wanted {
  const char* element;
  double cell_mm;
  bool bar;
};

class PlanDelaunay : public testing::Test {
 protected:
  /// Degrees of freedom that the plan tells over those of the run; each is to be within a quarter of the other.
  void check(const std::string& body, const image::Mask& mask, std::initializer_list<Wanted> all) {
    image::writeVolume(folder_ / (body + ".nii.gz"), mask);
    for (const Wanted& w : all) {
      const Scene s = parseScene(
          R"({ "schema": "glisson/scene/1", "geometry": { "kind": "mask", "file": ")" + body +
              R"(.nii.gz", "cell_mm": 4 }, "material": { "youngs_kPa": 6 },
          "supports": [ { "region": {"surface":"all"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1 } ], "loads": [ )" +
              (w.bar ? R"({ "kind": "retractor" })" : R"({ "kind": "body_force", "N_per_m3": [0,-100,0] })") +
              R"( ], "model": { "kind": "fem-tet", "mesh": "delaunay", "element": ")" + w.element +
              R"(", "cell_mm": )" + std::to_string(w.cell_mm) + R"(, "tool_cell_mm": )" +
              std::to_string(0.5 * w.cell_mm) + "} }",
          folder_.path());
      const std::vector<PlanStep> steps = plan(s);
      const auto mesh = std::find_if(steps.begin(), steps.end(), [](const PlanStep& p) { return p.step == "mesh"; });
      ASSERT_NE(mesh, steps.end());
      const double told = std::stod(mesh->why.substr(mesh->why.find(" cells, ") + 8));
      RunOptions options;
      options.discretisation = false;
      const double ratio = told / run(s, options).primary.dofs;
      std::printf("  %s, %s of %.0f mm%s: %.0f degrees of freedom told, %.2f of those made\n", body.c_str(), w.element,
                  w.cell_mm, w.bar ? " and a bar" : "", told, ratio);
      EXPECT_LT(ratio, 1.25) << mesh->why;
      EXPECT_GT(ratio, 0.75) << mesh->why;
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(PlanDelaunay, OfABall) {
  check("ball", ellipsoid({60, 60, 60}), {{"T4", 10, false}, {"T4", 20, true}, {"T10", 16, false}, {"T10", 20, true}});
}

TEST_F(PlanDelaunay, OfAFlatBody) {
  check("flat", ellipsoid({80, 60, 25}), {{"T4", 10, false}, {"T4", 20, true}, {"T10", 16, false}, {"T10", 20, true}});
}

TEST_F(PlanDelaunay, OfALiver) {
  check("liver", phantom::makePhantom(3).liver, {{"T4", 12, true}, {"T4", 20, false}, {"T10", 18, true}});
}

}  // namespace
}  // namespace glisson::pipeline
