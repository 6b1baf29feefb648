// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/linear_gap.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/diagnostic.h"
#include "base/error.h"
#include "mechanics/measures.h"
#include "retraction/body.h"
#include "retraction/discretisation.h"
#include "retraction/offered.h"

namespace glisson::retraction {
namespace {

constexpr double mToMm = 1e3;

using mechanics::NodalField;

/// A displacement of the model at the nodes of a body in larger cells; nodes that lie off the model take the mean of
/// those beside them. False where that leaves some without.
bool carry(const Model& model, const Result& result, const Body& coarse, NodalField& u_m) {
  const mechanics::VoxelMesh& mesh = coarse.mesh();
  std::vector<Eigen::Vector3d> places_mm;
  for (int node = 0; node < mesh.nodeCount(); ++node) places_mm.push_back(coarse.nodePosition_mm(node));
  const std::vector<Eigen::Vector3d> u_mm = displacementAt(model, result, places_mm);
  u_m.resize(3, mesh.nodeCount());
  std::vector<char> known(places_mm.size(), 0);
  for (std::size_t n = 0; n < u_mm.size(); ++n) {
    known[n] = u_mm[n].allFinite() ? 1 : 0;
    if (known[n] != 0) u_m.col(static_cast<Eigen::Index>(n)) = coarse.vectorToLocal(u_mm[n]) / mToMm;
  }
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<char> before = known;
    for (int node = 0; node < mesh.nodeCount(); ++node) {
      if (before[static_cast<std::size_t>(node)] != 0) continue;
      const Eigen::Vector3i at = mesh.latticeOf(node);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      int count = 0;
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Eigen::Vector3i p = at;
          p[axis] += step;
          if ((p.array() < 0).any() || (p.array() > mesh.cells().array()).any()) continue;
          const int beside = mesh.nodeAt(p.x(), p.y(), p.z());
          if (beside < 0 || before[static_cast<std::size_t>(beside)] == 0) continue;
          sum += u_m.col(beside);
          ++count;
        }
      if (count == 0) continue;
      u_m.col(node) = sum / count;
      known[static_cast<std::size_t>(node)] = 1;
    }
  }
  return std::all_of(known.begin(), known.end(), [](char k) { return k != 0; });
}

/// The figures of a correction on a body's nodes.
void fill(const Body& body, const NodalField& d_m, const std::vector<Eigen::Vector3d>& contact_mm,
          const std::vector<Eigen::Vector3d>& landmarks_mm, LinearGap& gap) {
  gap.max_mm = mToMm * d_m.colwise().norm().maxCoeff();
  for (int cell = 0; cell < body.mesh().cellCount(); ++cell) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : body.mesh().nodesOf(cell)) sum += d_m.col(node);
    gap.mean_mm += mToMm * sum.norm() / (8.0 * body.mesh().cellCount());
  }
  const auto lengths_mm = [&](const std::vector<Eigen::Vector3d>& points_mm) {
    std::vector<double> out;
    for (const Eigen::Vector3d& p : points_mm)
      if (const auto d = mechanics::displacementAt(body.mesh(), d_m, body.toLocal_m(p)))
        out.push_back(mToMm * d->norm());
    return out;
  };
  if (const std::vector<double> there = lengths_mm(contact_mm); !there.empty()) {
    gap.at_retractor_mm = 0.0;
    for (const double d : there) *gap.at_retractor_mm += d / static_cast<double>(there.size());
  }
  if (const std::vector<double> there = lengths_mm(landmarks_mm); !there.empty())
    gap.landmarks_max_mm = *std::max_element(there.begin(), there.end());
}

}  // namespace

LinearGap linearGap(const Model& model, const Setup& setup, const Result& result,
                    const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress, int largestDofs) {
  if (result.kinematics != Kinematics::Linear)
    throw BadArgument("linearGap: the result does not come from linear kinematics");
  Setup bare = setup;  // K u stands for the load, and a bar may find no contact on larger cells
  bare.loads.clear();
  std::vector<Eigen::Vector3d> contact_mm;
  auto body = std::make_unique<Body>(model);
  for (const int node : result.contactNodes) contact_mm.push_back(body->nodePosition_mm(node));
  NodalField u_m = result.nodal_u_m;
  MechanicsScene scene = toMechanics(*body, model, bare);
  Model larger = model;
  while (3 * body->mesh().nodeCount() > largestDofs) {
    try {
      larger = coarsened(larger);
      auto coarse = std::make_unique<Body>(larger);
      NodalField carried;
      if (!carry(model, result, *coarse, carried)) break;
      scene = toMechanics(*coarse, larger, bare);
      body = std::move(coarse);
      u_m = std::move(carried);
    } catch (const BadInput&) {
      break;  // a region or a support that larger cells do not have
    }
  }
  // An answer of another mesh compresses these cells a little, which near incompressibility would count as much as a
  // load.
  constexpr double carriedPoisson = 0.49;
  double& poisson = scene.problem.body.poisson;
  if (setup.model.kind != ModelKind::FemHex || body->mesh().nodeCount() != result.nodal_u_m.cols())
    poisson = std::min(poisson, carriedPoisson);
  mechanics::SolverOptions options;
  options.element = setup.model.kind == ModelKind::FemHex ? setup.model.element : mechanics::HexElement::Incompatible;
  mechanics::LinearGap found = mechanics::linearGap(scene.problem, u_m, options, progress);
  LinearGap gap;
  gap.stability = found.stability;
  gap.why = std::move(found.why);
  gap.known = found.computed;
  if (gap.known) fill(*body, found.correction_m, contact_mm, landmarks_mm, gap);
  return gap;
}

bool kinematicsValid(const Result& result) {
  if (!result.drawable) return false;
  if (result.kinematics != Kinematics::Linear || !result.linearGap) return result.linearTrusted;
  return result.linearGap->known ? result.linearGap->trusted() : result.linearTrusted;
}

bool linearValid(const Result& r) {
  constexpr double strain = 0.10, rotation_deg = 15;  // as mechanics::validity
  if (r.kinematics == Kinematics::Linear) return r.linearTrusted;
  if (!r.linearTrusted) return false;
  if (r.linearGap && r.linearGap->known) return r.linearGap->trusted();
  return r.p95_strain < strain && r.max_rotation_deg < rotation_deg;
}

LinearGap gapBetween(const Model& model, const Result& linear, const Result& large,
                     const std::vector<Eigen::Vector3d>& landmarks_mm) {
  LinearGap gap;
  gap.known = true;
  const Body body(model);
  fill(body, large.nodal_u_m - linear.nodal_u_m, {}, landmarks_mm, gap);
  double sum = 0.0, weight = 0.0;
  const auto there = [&](double apart_mm, double w) {
    sum += w * apart_mm;
    weight += w;
    gap.max_mm = std::max(gap.max_mm, apart_mm);
  };
  // At the bar: what either answer holds.
  if (linear.contact && large.contact) {
    const RigidContact &a = *linear.contact, &b = *large.contact;
    for (std::size_t i = 0; i < a.sample_mm.size(); ++i)
      if (a.pressure_kPa[i] > 0.0 || b.pressure_kPa[i] > 0.0)
        there((a.sample_u_mm[i] - b.sample_u_mm[i]).norm(), a.sample_mm2[i]);
  }
  for (const int node : large.contactNodes)
    there(mToMm * (large.nodal_u_m.col(node) - linear.nodal_u_m.col(node)).norm(), 1.0);
  if (weight > 0.0) gap.at_retractor_mm = sum / weight;
  return gap;
}

void putGap(const Setup& setup, LinearGap found, Result& result) {
  result.linearGap = std::move(found);
  const LinearGap& gap = *result.linearGap;
  if (gap.stability == mechanics::Stability::Unstable) {
    result.linearTrusted = false;
    result.doubt(DiagnosticCode::LinearUnstable, {{"instead", wayToLargeDeformation(setup)}});
  } else if (gap.known && !gap.trusted()) {
    result.doubt(DiagnosticCode::LinearGapLarge,
                 {{"missed_mm", gap.landmarks_max_mm.value_or(gap.max_mm)},
                  {"where", std::string(gap.landmarks_max_mm ? "at the vessels" : "in the body")},
                  {"limit_mm", LinearGap::limit_mm},
                  {"instead", wayToLargeDeformation(setup)}});
  }
}

void judgeByGap(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& landmarks_mm,
                Result& result, const Progress& progress) {
  if (result.kinematics != Kinematics::Linear || result.contact || !result.solver.converged() || result.linearGap)
    return;
  putGap(setup, linearGap(model, setup, result, landmarks_mm, progress), result);
}

}  // namespace glisson::retraction
