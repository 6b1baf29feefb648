// SPDX-License-Identifier: GPL-3.0-or-later
#include "uncertainty/one_stiffness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "mechanics/measures.h"
#include "retraction/smooth_body.h"
#include "uncertainty/random_field.h"

namespace glisson::uncertainty {
namespace {

constexpr double mmToM = 1e-3;

retraction::ContactScene sceneOf(const Retracted& r, const retraction::Body& body, const retraction::Setup& setup) {
  const std::optional<retraction::Retractor> bar = retraction::rigidBarOf(setup);
  if (!bar || !bar->at_mm || !bar->axis) throw BadArgument("uncertainty: the setup has no rigid bar in its place");
  retraction::Setup used = setup;
  used.kinematics = r.result.kinematics;
  return retraction::contactScene(body, r.model, used, retraction::toMechanics(body, r.model, setup), *bar);
}

std::vector<double> growthOf(const Retracted& r, const retraction::ContactScene& scene) {
  if (!r.model.smooth) return {};
  return mechanics::growthOf(scene.problem, r.model.smooth->fractions(r.model.youngs_kPa.grid).values);
}

}  // namespace

OneStiffness::OneStiffness(const Retracted& retracted, const retraction::Setup& setup)
    : retracted_(retracted),
      body_(retracted.model),
      scene_(sceneOf(retracted, body_, setup)),
      growth_Pa_m_(growthOf(retracted, scene_)) {
  if (!retracted.result.contact || !retracted.result.solver.converged())
    throw BadArgument("uncertainty: the retraction is no answer in contact");
  mechanics::ContactOptions options;
  options.tolerance = std::max(1e-6, setup.solver.tolerance);
  const retraction::RigidContact& c = *retracted.result.contact;
  const Eigen::Vector3d start_m =
      body_.toLocal_m(c.bar_mm.front()) + scene_.layers.cast<double>().cwiseProduct(body_.voxels().h_m);
  equilibrium_ =
      std::make_unique<mechanics::Equilibrium>(scene_.problem, options, c.cut_u_m, mmToM * c.travel_mm, start_m);
}

double OneStiffness::surface_m2() const {
  double sum = 0;
  for (const mechanics::SurfaceSample& s : scene_.problem.surface) sum += s.area_m2;
  return sum;
}

Eigen::Vector3d OneStiffness::along() const {
  const std::vector<Eigen::Vector3d>& line = equilibrium_->bar().centreline_m;
  return (line.back() - line.front()).normalized();
}

Eigen::Matrix3d OneStiffness::toLps() const {
  Eigen::Matrix3d axes;
  for (int a = 0; a < 3; ++a) axes.col(a) = body_.vectorToLps(Eigen::Vector3d::Unit(a));
  return axes;
}

image::ScalarVolume OneStiffness::onGrid(const std::vector<float>& perCell) const {
  image::ScalarVolume volume(retracted_.model.youngs_kPa.grid, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t cell = 0; cell < perCell.size(); ++cell)
    volume.at(body_.mesh().cellOf(static_cast<int>(cell))) = perCell[cell];
  return volume;
}

Places OneStiffness::places(const std::vector<Eigen::Vector3d>& landmarks_mm, const Retracted* other) const {
  Places p;
  for (std::size_t i = 0; i < landmarks_mm.size(); ++i) {
    const Eigen::Vector3d at = body_.toLocal_m(landmarks_mm[i]);
    if (!mechanics::displacementAt(body_.mesh(), retracted_.result.nodal_u_m, at)) continue;
    p.landmark.push_back(i);
    p.landmark_m.push_back(at);
  }
  const retraction::RigidContact& c = *retracted_.result.contact;
  for (std::size_t i = 0; i < c.pressure_kPa.size(); ++i)
    if (c.pressure_kPa[i] > 0 || (other != nullptr && other->result.contact->pressure_kPa[i] > 0)) {
      p.sample.push_back(i);
      p.sample_mm2.push_back(c.sample_mm2[i]);
    }
  p.cells = static_cast<std::size_t>(body_.mesh().cellCount());
  return p;
}

Eigen::VectorXf OneStiffness::gathered(const Places& places, const mechanics::NodalField& u_m,
                                       const Eigen::Matrix3Xd& surface_u_m) const {
  Eigen::VectorXf out(static_cast<Eigen::Index>(3 * places.count()));
  Eigen::Index at = 0;
  const auto put = [&](const Eigen::Vector3d& u) {
    out.segment<3>(at) = (u / mmToM).cast<float>();
    at += 3;
  };
  for (const Eigen::Vector3d& p : places.landmark_m) put(*mechanics::displacementAt(body_.mesh(), u_m, p));
  for (const std::size_t s : places.sample) put(surface_u_m.col(static_cast<Eigen::Index>(s)));
  for (int cell = 0; cell < static_cast<int>(places.cells); ++cell) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : body_.mesh().nodesOf(cell)) sum += u_m.col(node);
    put(sum / 8.0);
  }
  return out;
}

Eigen::VectorXf OneStiffness::displacements(const Places& places) const {
  const std::vector<Eigen::Vector3d>& u_mm = retracted_.result.contact->sample_u_mm;
  Eigen::Matrix3Xd surface_m(3, static_cast<Eigen::Index>(u_mm.size()));
  for (std::size_t i = 0; i < u_mm.size(); ++i)
    surface_m.col(static_cast<Eigen::Index>(i)) = mmToM * body_.vectorToLocal(u_mm[i]);
  return gathered(places, retracted_.result.nodal_u_m, surface_m);
}

Eigen::VectorXf OneStiffness::displacements(const Places& places, const mechanics::EquilibriumMotion& motion) const {
  return gathered(places, retraction::onModelNodes(body_, scene_, motion.u_m), motion.surface_u_m);
}

std::optional<Leverage> OneStiffness::leverage(const mechanics::MotionWeights& figure, const Places& places) const {
  constexpr double tolerance = 1e-5, tenPercent = 0.1, m3ToMl = 1e6;
  const std::optional<std::vector<double>> gradient = equilibrium_->gradientByModuli(figure, tolerance);
  if (!gradient) return {};
  const mechanics::VoxelBody& body = scene_.problem.problem.body;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double area = 0;
  for (std::size_t i = 0; i < places.sample.size(); ++i) {
    middle += places.sample_mm2[i] * scene_.problem.surface[places.sample[i]].p_m;
    area += places.sample_mm2[i];
  }
  if (!(area > 0)) return {};
  middle /= area;
  struct Cell {
    double share = 0, away_m = 0;
  };
  std::vector<Cell> cells;
  Leverage l;
  double all = 0;
  for (int k = 0; k < body.cells.z(); ++k)
    for (int j = 0; j < body.cells.y(); ++j)
      for (int i = 0; i < body.cells.x(); ++i) {
        const std::size_t c = body.cell(i, j, k);
        if (!(body.E_Pa[c] > 0)) continue;
        const Eigen::Vector3d centre =
            (Eigen::Vector3d(i, j, k) + Eigen::Vector3d::Constant(0.5)).cwiseProduct(body.h_m);
        cells.push_back({std::abs((*gradient)[c]), (centre - middle).norm()});
        l.per10percent_mm += tenPercent * (*gradient)[c] / mmToM;
        all += cells.back().share;
      }
  if (!(all > 0)) return {};
  const auto untilHalf = [&](auto before) {
    std::sort(cells.begin(), cells.end(), before);
    double sum = 0;
    std::size_t n = 0;
    while (n < cells.size() && sum < 0.5 * all) sum += cells[n++].share;
    return n;
  };
  l.half_mL = static_cast<double>(untilHalf([](const Cell& a, const Cell& b) { return a.share > b.share; })) *
              body.h_m.prod() * m3ToMl;
  l.halfWithin_mm =
      cells[untilHalf([](const Cell& a, const Cell& b) { return a.away_m < b.away_m; }) - 1].away_m / mmToM;
  return l;
}

mechanics::EquilibriumMotion OneStiffness::fromRest(const mechanics::Change& change, const Progress& progress) const {
  mechanics::EquilibriumMotion m;
  const mechanics::ContactSolution s =
      mechanics::solveContact(mechanics::changed(scene_.problem, change), {}, progress);
  m.iterations = s.newton;
  if (s.outcome != mechanics::ContactOutcome::Reached) return m;
  const retraction::RigidContact& here = *retracted_.result.contact;
  m.found = true;
  m.u_m = s.solution.u_m - here.cut_u_m;
  m.surface_u_m = s.surface_u_m;
  for (std::size_t i = 0; i < here.sample_u_mm.size(); ++i)
    m.surface_u_m.col(static_cast<Eigen::Index>(i)) -= mmToM * body_.vectorToLocal(here.sample_u_mm[i]);
  // Seen from the bar at hand: the changed one may touch earlier or later.
  const mechanics::RigidBar& own = equilibrium_->bar();
  const mechanics::RigidBar there = mechanics::moved(own, change.barShift_m, change.barTurn_rad, change.pivot_m);
  m.travel_m = s.travel_m - mmToM * here.travel_mm + (s.bar.centre_m() - there.centre_m()).dot(there.hoist);
  return m;
}

std::vector<double> OneStiffness::noiseField(const Elastogram& elastogram, const Spreads& spreads,
                                             std::uint64_t seed) const {
  const mechanics::VoxelBody& body = scene_.problem.problem.body;
  const Eigen::Vector3d h_mm = body.h_m / mmToM;
  const std::vector<float> near = randomField(body.cells, h_mm, spreads.correlation_mm, 2 * seed);
  const std::vector<float> filled = randomField(body.cells, h_mm, spreads.fillCorrelation_mm, 2 * seed + 1);
  std::vector<double> field(body.E_Pa.size(), 0.0);
  for (int k = 0; k < body.cells.z(); ++k)
    for (int j = 0; j < body.cells.y(); ++j)
      for (int i = 0; i < body.cells.x(); ++i) {
        const std::size_t c = body.cell(i, j, k);
        if (!(body.E_Pa[c] > 0)) continue;
        const Eigen::Vector3i own = Eigen::Vector3i(i, j, k) - scene_.layers;
        const bool measured = elastogram.origin.grid.contains(own) && elastogram.origin.at(own) == 1;
        field[c] = elastogram.noise * static_cast<double>(near[c]) +
                   (measured ? 0.0 : elastogram.liver * static_cast<double>(filled[c]));
      }
  return field;
}

}  // namespace glisson::uncertainty
