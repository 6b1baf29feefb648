// SPDX-License-Identifier: GPL-3.0-or-later

// What cannot be used is refused in words; what can is used by a stated rule.
#include <limits>

#include "mechanics/beam.h"
#include "mechanics/static_solve.h"
#include "mechanics/supports.h"
#include "retraction/simulate.h"
#include "roi/contour_stack.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;
using mechanics::VoxelMesh;

/// One bad modulus in voxel (2, 3, 1), through the door that files come in by.
Outcome badModulus(float value_kPa) {
  image::Grid grid;
  grid.size = {5, 5, 4};
  image::ScalarVolume E(grid, 6.0f);
  E.at(2, 3, 1) = value_kPa;
  return refused([&] { retraction::makeModel(E, 0.45, defaults::liverDensity, false); }, {"(2, 3, 1)", "slice 1"});
}

Outcome held(const std::vector<Vector3d>& at_m, int expectedModes, const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({6, 4, 4}, {0.06, 0.04, 0.04}, 6e3, 0.45);
  const VoxelMesh mesh(p.body);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -100});
  for (const Vector3d& x : at_m)
    for (const int n : nodesWhere(mesh, [&](const Vector3d& y) { return (x - y).norm() < 1e-9; }))
      p.supports.fixations.push_back({n, {true, true, true}, Vector3d::Zero()});
  return refused([&] { mechanics::solveStatic(p, {}, progress); }, {words(expectedModes, " free rigid mode")});
}

mechanics::VoxelBody twoBlocks(const std::function<bool(const Vector3d&)>& filled) {
  mechanics::VoxelBody body = solidBox({12, 6, 4}, {0.12, 0.06, 0.04}, 6e3, 0.45);
  paint(body, [&](const Vector3d& c) { return filled(c) ? 6e3 : 0.0; });
  return body;
}

Outcome island(const Progress& progress) {
  mechanics::Problem p;
  p.body = twoBlocks([](const Vector3d& c) { return c.x() < 0.06 || c.x() > 0.09; });
  const VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 0);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -100});
  Outcome o = refused([&] { mechanics::solveStatic(p, {}, progress); }, {"mL", "drop"});
  if (!o.good) return o;
  // Dropped, it solves, and the volume is told.
  double dropped = 0.0;
  mechanics::Problem rest;
  rest.body = mechanics::dropComponents(p.body, mesh, mechanics::findUnsupported(mesh, p.supports), &dropped);
  const VoxelMesh left(rest.body);
  rest.supports.fixations = clampSide(left, 0);
  rest.f_N = mechanics::bodyForce(left, {0, 0, -100});
  const mechanics::Solution r = mechanics::solveStatic(rest, {}, progress);
  o.add(r.report);
  o.good = r.report.converged() && std::abs(dropped - 3 * 6 * 4 * 1e-6) < 1e-12;
  o.detail += words(" | dropped ", 1e6 * dropped, " mL, then solved");
  return o;
}

Outcome edgeJoint(const Progress& progress) {
  mechanics::Problem p;
  p.body = twoBlocks([](const Vector3d& c) { return (c.x() < 0.06) == (c.y() < 0.03); });
  const VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 0);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -100});
  return refused([&] { mechanics::solveStatic(p, {}, progress); }, {"hinge"});
}

Outcome oneVoxel(const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({1, 1, 1}, Vector3d::Constant(1.64e-3), 6e3, 0.0);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 4);
  const double traction = 6.0;
  p.f_N = mechanics::tractionForce(mesh, facesOn(mesh, 5), Vector3d(0, 0, traction));
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  const double exact = traction / 6e3 * 1.64e-3;
  Outcome o;
  o.add(r.report);
  const double off = std::abs(r.u_m.row(2).maxCoeff() / exact - 1);
  o.good = off <= 1e-8;
  o.detail = words("a single voxel stretches by sigma L / E to ", off);
  return o;
}

Outcome sliver(const Progress& progress) {
  // A slab one voxel thick, bent: 30 × 4 × 1 cells.
  mechanics::Cantilever beam{.length_m = 0.06, .width_m = 0.008, .height_m = 0.002, .E_Pa = 12e3, .poisson = 0.0};
  const double load = mechanics::loadForTip_N_m(beam, 1e-3);
  mechanics::Problem p;
  p.body = solidBox({30, 4, 1}, {beam.length_m, beam.width_m, beam.height_m}, beam.E_Pa, 0.0);
  const VoxelMesh mesh(p.body);
  p.supports.fixations = clampSide(mesh, 0);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -load / beam.area_m2()});
  const mechanics::Solution r = mechanics::solveStatic(p, {}, progress);
  const double exact = mechanics::timoshenkoDeflection_m(beam, load, beam.length_m);
  const double tip = -r.u_m.row(2).minCoeff();
  Outcome o;
  o.add(r.report);
  o.good = std::abs(tip / exact - 1) <= 0.05 && r.report.converged();
  o.detail = words("tip ", 1e3 * tip, " mm, Timoshenko ", 1e3 * exact);
  return o;
}

roi::ContourStack polygon(const std::vector<Vector3d>& points) {
  roi::Polygon p;
  p.points_lps_mm.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) p.points_lps_mm.col(static_cast<Eigen::Index>(i)) = points[i];
  roi::ContourStack stack;
  stack.polygons.push_back(p);
  return stack;
}

image::Grid plane() {
  image::Grid grid;
  grid.size = {40, 40, 3};
  return grid;
}

std::size_t voxels(const roi::ContourStack& stack) {
  std::size_t n = 0;
  for (const std::uint8_t v : roi::rasterise(stack, plane()).values) n += v;
  return n;
}

Outcome selfCrossing(const Progress&) {
  // A bow tie: two triangles of base 20 and height 10; the crossing is no hole and nothing counts twice.
  const roi::ContourStack tie = polygon({{5.3, 5.3, 1}, {25.3, 25.3, 1}, {25.3, 5.3, 1}, {5.3, 25.3, 1}});
  const double area = roi::area_mm2(tie), counted = static_cast<double>(voxels(tie));
  Outcome o;
  o.good = std::abs(area - 200) <= 1e-9 && std::abs(counted - area) <= 20;
  o.detail = words("even-odd rule: area ", area, " mm2 of two triangles, ", counted, " voxels of 1 mm2");
  return o;
}

Outcome hole(const Progress&) {
  roi::ContourStack ring = polygon({{5.3, 5.3, 1}, {25.3, 5.3, 1}, {25.3, 25.3, 1}, {5.3, 25.3, 1}});
  ring.polygons.push_back(polygon({{10.3, 10.3, 1}, {20.3, 10.3, 1}, {20.3, 20.3, 1}, {10.3, 20.3, 1}}).polygons[0]);
  const double area = roi::area_mm2(ring);
  const std::size_t counted = voxels(ring);
  Outcome o;
  o.good = std::abs(area - 300) <= 1e-9 && counted == 300;
  o.detail = words("a polygon inside another is a hole: ", area, " mm2, ", counted, " voxels of 1 mm2");
  return o;
}

}  // namespace

Scenes refusalScenes(const StabilityOptions&) {
  Scenes s;
  const auto bad = [&](const std::string& name, float value) {
    s.push_back(
        {"modulus " + name, "refused, naming voxel and slice", [value](const Progress&) { return badModulus(value); }});
  };
  bad("negative", -1.0f);
  bad("not a number", std::numeric_limits<float>::quiet_NaN());
  bad("infinite", std::numeric_limits<float>::infinity());
  bad("1e30 kPa", 1e30f);
  s.push_back({"modulus 0 everywhere", "refused: nothing is there", [](const Progress&) {
                 return refused([] { VoxelMesh(solidBox({3, 3, 3}, Vector3d::Constant(0.03), 0.0, 0.45)); }, {});
               }});
  for (const double nu : {0.5, 0.6, -1.0, std::numeric_limits<double>::quiet_NaN()})
    s.push_back({words("Poisson's ratio ", nu), "refused, with the range", [nu](const Progress&) {
                   return refused([nu] { VoxelMesh(solidBox({3, 3, 3}, Vector3d::Constant(0.03), 6e3, nu)); }, {"0.5"});
                 }});
  s.push_back({"density 0", "refused", [](const Progress&) {
                 mechanics::VoxelBody body = solidBox({3, 3, 3}, Vector3d::Constant(0.03), 6e3, 0.45);
                 body.density_kg_m3 = 0;
                 return refused([&] { const VoxelMesh mesh(body); }, {"density"});
               }});
  const Vector3d a(0, 0, 0), b(0.06, 0, 0), c(0.03, 0, 0);
  s.push_back({"no support, static", "refused: 6 free rigid modes", [](const Progress& p) { return held({}, 6, p); }});
  s.push_back({"one fixed node", "refused: 3 free rigid modes", [=](const Progress& p) { return held({a}, 3, p); }});
  s.push_back({"two fixed nodes", "refused: 1 free rigid mode", [=](const Progress& p) { return held({a, b}, 1, p); }});
  s.push_back({"three fixed nodes in a line", "refused: 1 free rigid mode", [=](const Progress& p) {
                 return held({a, b, c}, 1, p);
               }});
  s.push_back({"island of voxels", "refused, named with its volume; solves once dropped", island});
  s.push_back({"blocks that share an edge only", "refused: a hinge carries nothing", edgeJoint});
  s.push_back({"one voxel", "stretches as a bar", oneVoxel});
  s.push_back({"slab one voxel thick", "within 5 % of Timoshenko", sliver});
  s.push_back({"polygon that crosses itself", "even-odd rule, exact area", selfCrossing});
  s.push_back({"polygon with a hole", "even-odd rule, exact area", hole});
  s.push_back({"region of interest off the image", "refused", [](const Progress&) {
                 return refused([] { voxels(polygon({{105, 105, 1}, {125, 105, 1}, {125, 125, 1}})); }, {});
               }});
  s.push_back({"region of interest between the slices' reach", "refused", [](const Progress&) {
                 return refused([] { voxels(polygon({{5, 5, 9}, {25, 5, 9}, {25, 25, 9}})); }, {});
               }});
  return s;
}

}  // namespace glisson::study
