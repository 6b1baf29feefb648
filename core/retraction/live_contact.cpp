#include "retraction/live_contact.h"

#include <algorithm>
#include <cmath>

#include "mechanics/contact/contact_solver.h"
#include "retraction/rigid_contact.h"

namespace glisson::retraction {
namespace {

using mechanics::ContactSolver;

constexpr double mmPerM = 1e3;
constexpr double softest_N_mm = 0.02;   ///< rise of the force with travel that is counted on, at least
constexpr double farthest_mm = 200.0;
constexpr double met = 3e-3;            ///< of the force asked for
constexpr double close = 0.2;           ///< of the force asked for: from there on the bar waits for the liver, and goes
constexpr double closeStep_mm = 0.5;    ///< by no more than this
constexpr double still_mm = 0.03;       ///< distance from equilibrium below which a force is believed

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
  points_ = static_cast<int>(points_mm.size());
  dofs_ = tracker_->dofs();
  for (int a = 0; a < 3; ++a) axes_.col(a) = body.vectorToLps(Eigen::Vector3d::Unit(a));
}

/// Where the bar has to go along the hoist for this force, by the rise of the force that was last seen. Past the largest
/// force that the liver bears the bar stays.
double ContactRetraction::alongFor(double force_N) {
  const bool still = remaining_mm_ < still_mm;  // a force on the way to equilibrium says nothing
  if (still && (forceAlong_N_ > best_N_ || force_N <= forceAlong_N_)) {
    best_N_ = forceAlong_N_;
    bestAt_mm_ = along_mm_;
    slips_ = false;
  }
  slips_ = slips_ || along_mm_ > farthest_mm ||
           (still && along_mm_ > bestAt_mm_ + 1.0 && forceAlong_N_ < ContactSolver::slipFall * best_N_) ||
           along_mm_ > bestAt_mm_ + mmPerM * ContactSolver::slipTravel_m;
  if (slips_) return along_mm_;
  const double off_N = force_N - forceAlong_N_;
  if (std::abs(off_N) <= met * std::abs(force_N)) return along_mm_;
  const double step_mm = off_N / std::max(stiffness_N_mm_, softest_N_mm);
  if (std::abs(off_N) > close * std::abs(force_N)) return along_mm_ + step_mm;
  if (!still) return along_mm_;
  return along_mm_ + std::clamp(step_mm, -closeStep_mm, closeStep_mm);
}

LiveAnswer ContactRetraction::follow(const LiveTarget& target) {
  double along = target.tool_mm.dot(hoist_);
  const Eigen::Vector3d across = target.tool_mm - along * hoist_;
  const double asked_N = target.force_N ? target.force_N->dot(hoist_) : 0.0;
  if (target.force_N)
    along = alongFor(asked_N);
  else
    slips_ = false, best_N_ = 0.0, bestAt_mm_ = along_mm_;
  const Eigen::Vector3d goal_mm = across + along * hoist_;
  const mechanics::TrackedState& state = tracker_->moveTowards(axes_.transpose() * goal_mm / mmPerM);
  LiveAnswer answer;
  answer.tool_mm = mmPerM * axes_ * state.moved_m;
  answer.force_N = axes_ * state.force_N;
  const double now_mm = answer.tool_mm.dot(hoist_), now_N = answer.force_N.dot(hoist_);
  answer.remaining_mm = remaining_mm_ = mmPerM * state.remaining_m;
  if (remaining_mm_ < still_mm && std::abs(now_mm - seenAt_mm_) > 1e-3) {
    stiffness_N_mm_ = (now_N - seen_N_) / (now_mm - seenAt_mm_);
    seenAt_mm_ = now_mm;
    seen_N_ = now_N;
  }
  along_mm_ = now_mm;
  forceAlong_N_ = now_N;
  answer.slips = slips_;
  const bool arrived = (answer.tool_mm - goal_mm).norm() < 1e-3;
  const bool meets = !target.force_N || slips_ || std::abs(now_N - asked_N) <= met * std::abs(asked_N);
  answer.atRest = state.atRest && arrived && meets;
  return answer;
}

void ContactRetraction::displacements(Eigen::Matrix3Xd& u_mm) const {
  tracker_->displacements(u_mm);
  const Eigen::Matrix3d toLps = mmPerM * axes_;
  for (Eigen::Index n = 0; n < u_mm.cols(); ++n) u_mm.col(n) = (toLps * u_mm.col(n)).eval();
}

}  // namespace glisson::retraction
