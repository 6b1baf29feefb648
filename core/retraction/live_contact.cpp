// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/live_contact.h"

#include <algorithm>

#include "retraction/rigid_contact.h"

namespace glisson::retraction {
namespace {

constexpr double mmPerM = 1e3;

}  // namespace

ContactRetraction::ContactRetraction(const Model& model, const Setup& setup, const Retractor& bar,
                                     const std::vector<Eigen::Vector3d>& points_mm, const Progress& progress)
    : hoist_(bar.direction.normalized()) {
  const Body body(model);
  Setup used = setup;
  if (used.kinematics == Kinematics::Auto) used.kinematics = Kinematics::Hyperelastic;
  const ContactScene scene = contactScene(body, model, used, toMechanics(body, model, used), bar);
  progress.report(0.5, "coarse cells");
  const Eigen::Vector3d shift_m = scene.layers.cast<double>().cwiseProduct(body.voxels().h_m);
  std::vector<Eigen::Vector3d> points_m;
  for (const Eigen::Vector3d& p : points_mm) points_m.push_back(body.toLocal_m(p) + shift_m);
  tracker_.emplace(scene.problem, points_m, mechanics::TrackerOptions{}, progress.part(0.5, 1.0));
  const mechanics::RigidBar& rest = tracker_->bar();
  toolPoint_mm_ = body.toLps_mm(rest.centre_m() + rest.radius_m * rest.hoist - shift_m);
  sceneForce_N_ = scene.problem.force_N.value_or(model.mass_kg * defaults::gravity_m_s2) * hoist_;
  if (scene.problem.travel_m)
    sceneTarget_.tool_mm = mmPerM * *scene.problem.travel_m * hoist_;
  else
    sceneTarget_.force_N = sceneForce_N_;
  points_ = static_cast<int>(points_mm.size());
  dofs_ = tracker_->dofs();
  cell_mm_ = mmPerM * tracker_->cell_m();
  for (int a = 0; a < 3; ++a) axes_.col(a) = body.vectorToLps(Eigen::Vector3d::Unit(a));
}

LiveAnswer ContactRetraction::follow(const LiveTarget& target) {
  double along = target.tool_mm.dot(hoist_);
  const Eigen::Vector3d across = target.tool_mm - along * hoist_;
  if (target.force_N)
    along = seeker_.next(target.force_N->dot(hoist_), seen_);
  else
    seeker_.forget(seen_);
  // A force leads the bar no deeper where it cuts; the hand may.
  if (target.force_N && tracker_->state().cuts) along = std::min(along, seen_.along_mm);
  const Eigen::Vector3d goal_mm = across + along * hoist_;
  const mechanics::TrackedState& state = tracker_->moveTowards(axes_.transpose() * goal_mm / mmPerM);
  LiveAnswer answer;
  answer.tool_mm = mmPerM * axes_ * state.moved_m;
  answer.force_N = axes_ * state.force_N;
  answer.remaining_mm = mmPerM * state.remaining_m;
  seen_ = {answer.tool_mm.dot(hoist_), answer.force_N.dot(hoist_), answer.remaining_mm < ForceSeeker::still_mm,
           state.atRest};
  answer.outcome = state.cuts ? LiveOutcome::Cuts : seeker_.slips() ? LiveOutcome::Slips : LiveOutcome::Borne;
  const bool arrived = (answer.tool_mm - goal_mm).norm() < 1e-3;
  const bool meets = !target.force_N || answer.outcome != LiveOutcome::Borne || seeker_.reached(seen_.force_N);
  answer.atRest = state.atRest && arrived && meets;
  return answer;
}

void ContactRetraction::displacements(Eigen::Matrix3Xd& u_mm) const {
  tracker_->displacements(u_mm);
  const Eigen::Matrix3d toLps = mmPerM * axes_;
  for (Eigen::Index n = 0; n < u_mm.cols(); ++n) u_mm.col(n) = (toLps * u_mm.col(n)).eval();
}

}  // namespace glisson::retraction
