// SPDX-License-Identifier: GPL-3.0-or-later

// A scene made by code, and a parameter study with it: how far does a rigid bar lift a block until it bears 1 N?
//
//          posterior: springs of 0.1 kPa/mm (a Winkler foundation)
//        +-----------------------------+
//        |  block 80 x 40 x 60 mm      |      y (posterior) up, x (left) to the right
//        +-------------O---------------+
//                      | bar, 10 mm thick, 40 mm long along z, pushed towards posterior until it bears 1 N
//
// usage: 02_scene     exit code 0 if the stiffer block is lifted and dented less
#include <cstdio>

#include "pipeline/run.h"
#include "pipeline/scene.h"

namespace {

/// The scene of the figure for one Young's modulus. Every field that is not set has the default of the scene file.
glisson::pipeline::Scene blockOnSprings(double youngs_kPa) {
  using namespace glisson;
  pipeline::Scene scene;
  scene.geometry.kind = pipeline::GeometrySpec::Kind::Box;
  scene.geometry.size_mm = {80, 40, 60};
  scene.geometry.cell_mm = {5, 5, 5};
  scene.material.kind = pipeline::MaterialSpec::Kind::Uniform;
  scene.material.value_kPa = youngs_kPa;

  retraction::SupportSpec& bed = scene.setup.supports.emplace_back();
  bed.kind = retraction::SupportSpec::Kind::Spring;
  bed.region = retraction::FaceRegion{"y+"};
  bed.stiffness_kPa_per_mm = 0.1;

  retraction::Retractor bar;
  bar.contact = retraction::ContactKind::Rigid;
  bar.length_mm = 40;
  bar.at_mm = Eigen::Vector3d(40, 0, 30);
  bar.axis = Eigen::Vector3d(0, 0, 1);
  bar.direction = {0, 1, 0};
  bar.force_N = 1.0;
  scene.setup.loads.push_back(bar);
  scene.setup.kinematics = retraction::Kinematics::Auto;
  scene.outputs.probes_mm = {{40, 20, 30}};
  return scene;
}

}  // namespace

int main() {
  double before_mm = 0.0;
  bool falls = true;
  std::printf("E kPa   travel mm   middle of the block mm   largest pressure kPa\n");
  for (const double youngs_kPa : {6.0, 12.0, 24.0}) {
    // No output folder: nothing is written, everything is in the result.
    const glisson::pipeline::RunResult run = glisson::pipeline::run(blockOnSprings(youngs_kPa), {});
    for (const std::string& text : run.diagnostics.texts(glisson::Severity::Warning)) std::printf("%s\n", text.c_str());
    if (!run.primary.solver.converged() || !run.primary.contact) return 1;
    const double travel_mm = run.primary.contact->travel_mm;
    std::printf("%5.0f %11.2f %24.2f %22.2f\n", youngs_kPa, travel_mm, run.primary.probe_u_mm.front().y(),
                run.primary.contact->pressureMax_kPa);
    falls = falls && (before_mm == 0.0 || travel_mm < before_mm);
    before_mm = travel_mm;
  }
  return falls ? 0 : 1;
}
