// SPDX-License-Identifier: GPL-3.0-or-later

// Whole scenes: comparison with the atlas, the retractor's contact, results that must not be drawn.
#include "pipeline/run.h"
#include "retraction/simulate.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;

/// A block of 100 × 60 × 50 mm, voxels of 5 mm, on the patient's axes.
image::Mask block() {
  image::Grid grid;
  grid.size = {20, 12, 10};
  grid.spacing_mm = Vector3d::Constant(5.0);
  grid.origin_lps_mm = Vector3d::Constant(2.5);
  return image::Mask(grid, 1);
}

retraction::Model blockModel() {
  const image::Mask cells = block();
  return retraction::makeModel(image::ScalarVolume(cells.grid, 6.0f), 0.45, defaults::liverDensity, true);
}

retraction::Setup onFace(const std::string& face) {
  retraction::Setup s;
  s.supports.push_back({.region = retraction::FaceRegion{face}});
  return s;
}

Outcome constantMap(const Progress& progress) {
  const image::Mask cells = block();
  pipeline::Scene scene;
  scene.geometry.kind = pipeline::GeometrySpec::Kind::Box;
  scene.geometry.size_mm = cells.grid.size.cast<double>().cwiseProduct(cells.grid.spacing_mm);
  scene.geometry.cell_mm = cells.grid.spacing_mm;
  scene.material.kind = pipeline::MaterialSpec::Kind::Map;
  scene.material.quantity = StiffnessQuantity::Shear;
  scene.setup = onFace("y+");
  scene.setup.loads.push_back(retraction::Traction{retraction::FaceRegion{"z-"}, {0.05, -0.02, 0.1}});
  scene.compare = pipeline::CompareSpec{};
  pipeline::Inputs inputs;
  inputs.stiffness.emplace();
  inputs.stiffness->values_kPa = image::ScalarVolume(cells.grid, static_cast<float>(defaults::atlasShear.kPa()));
  const pipeline::RunResult r = pipeline::run(scene, {}, progress, &inputs);
  Outcome o;
  o.add(r.primary.solver);
  o.good = r.difference && r.difference->max_mm == 0.0 && r.primary.max_displacement_mm > 0.01;
  o.detail = words("moves ", r.primary.max_displacement_mm, " mm; largest difference ", r.difference->max_mm,
                   " mm: both channels of an overlay hold the same picture");
  return o;
}

Outcome tooMuch(const Progress& progress) {
  retraction::Setup s = onFace("x-");
  s.loads.push_back(retraction::BodyForce{{0, 0, -4e5}});
  const retraction::Result r = retraction::simulate(blockModel(), s, {}, progress);
  Outcome o;
  o.add(r.solver);
  o.good = !r.drawable && !r.linearTrusted && !r.validity.empty();
  o.detail = words("moves ", r.max_displacement_mm, " mm: ", r.drawable ? "would be drawn" : "not drawn", "; ",
                   r.validity.empty() ? "no warning" : r.validity.front());
  return o;
}

Outcome inverted(const Progress& progress) {
  // Smaller than the body, but cells turn inside out under a sharp push.
  retraction::Setup s = onFace("y+");
  s.loads.push_back(retraction::Traction{retraction::BoxRegion{{45, -1, 20}, {55, 1, 30}}, {0, 30, 0}});
  const retraction::Result r = retraction::simulate(blockModel(), s, {}, progress);
  Outcome o;
  o.add(r.solver);
  o.good = !r.drawable && !r.linearTrusted;
  o.detail = words("moves ", r.max_displacement_mm, " mm: ", r.validity.empty() ? "no warning" : r.validity.front());
  return o;
}

retraction::Retractor bar(const Vector3d& at_mm, double diameter_mm, double length_mm) {
  retraction::Retractor b;
  b.at_mm = at_mm;
  b.diameter_mm = diameter_mm;
  b.length_mm = length_mm;
  b.force_N = 1.5;
  b.direction = {0, 0, 1};
  return b;
}

Outcome forceKept(const std::string& held, const retraction::Retractor& b, const Progress& progress) {
  retraction::Setup s = onFace(held);
  s.loads.push_back(b);
  const retraction::Result r = retraction::simulate(blockModel(), s, {}, progress);
  const double load = (r.load_N - Vector3d(0, 0, 1.5)).norm() / 1.5, balance = (r.load_N + r.reaction_N).norm() / 1.5;
  Outcome o;
  o.add(r.solver);
  o.good = load <= 1e-10 && balance <= 1e-6 && r.solver.converged();
  o.detail = words("1.5 N arrive within ", load, ", reactions balance them within ", balance, "; ",
                   r.contactNodes.size(), " nodes touched, ", r.max_displacement_mm, " mm");
  return o;
}

}  // namespace

Scenes retractionScenes(const StabilityOptions&) {
  Scenes s;
  s.push_back({"stiffness map constant and equal to the atlas", "difference exactly 0", constantMap});
  s.push_back({"displacement larger than the body", "marked invalid, no overlay", tooMuch});
  s.push_back({"cells turned inside out", "marked invalid, no overlay", inverted});
  s.push_back({"retractor on one voxel face", "total force kept", [](const Progress& p) {
                 return forceKept("z+", bar({50, 30, 0}, 1, 1), p);
               }});
  s.push_back({"retractor over the edge of the body", "total force kept", [](const Progress& p) {
                 return forceKept("z+", bar({100, 30, 0}, 10, 80), p);
               }});
  s.push_back({"retractor on fixed nodes", "total force kept, nothing moves there", [](const Progress& p) {
                 return forceKept("z-", bar({50, 30, 0}, 10, 80), p);
               }});
  s.push_back({"retractor off the surface", "refused: no contact", [](const Progress& p) {
                 retraction::Setup setup = onFace("z+");
                 setup.loads.push_back(bar({50, 30, -60}, 10, 80));
                 return refused([&] { retraction::simulate(blockModel(), setup, {}, p); }, {"no contact"});
               }});
  return s;
}

}  // namespace glisson::study
