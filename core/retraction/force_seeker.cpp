// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/force_seeker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/contact/contact_solver.h"

namespace glisson::retraction {
namespace {

using mechanics::ContactSolver;

constexpr double softest_N_mm = 0.02;  ///< rise of the force with travel that is counted on, at least
constexpr double close = 0.2;          ///< of the force asked for: from there on the bar waits for the liver, and goes
constexpr double closeStep_mm = 0.5;   ///< by no more than this
constexpr double unseen_mm = 6.0;      ///< way without a force that can be believed, at most
constexpr double narrowest_mm = 2e-5;  ///< of a bracket
constexpr double slipTravel_mm = 1e3 * ContactSolver::slipTravel_m;
constexpr double edge = 0.02;   ///< of a bracket: no nearer to its ends
constexpr double borne = 0.98;  ///< of the largest force met: what is taken to be borne on the way to it

bool meets(double force_N, double asked_N) {
  return std::abs(force_N - asked_N) <= std::max(ForceSeeker::met * std::abs(asked_N), ForceSeeker::least_N);
}

}  // namespace

bool ForceSeeker::reached(double force_N) const {
  return nearest_ || meets(force_N, asked_N_);
}

void ForceSeeker::forget(const Seen& now) {
  *this = {};
  last_ = now;
  best_.along_mm = goal_mm_ = now.along_mm;
}

void ForceSeeker::ask(double asked_N) {
  asked_N_ = asked_N;
  nearest_ = false;
  turns_ = 0;
  if (below_ && below_->force_N >= asked_N) above_ = std::exchange(below_, std::nullopt);
  if (above_ && above_->force_N < asked_N) below_ = std::exchange(above_, std::nullopt);
  returns_ = returns_ && below_ && above_;
  if (!slips_ || asked_N >= borne * best_.force_N || !(best_.along_mm > 0.0)) return;
  // The liver bore this on the way to the largest force: back there.
  slips_ = false;
  returns_ = true;
  below_ = Seen{};
  above_ = best_;
}

/// A settled state is an end of the bracket; an end on the wrong side of it was met on another way.
void ForceSeeker::enclose(const Seen& now) {
  const bool under = now.force_N < asked_N_;
  std::optional<Seen>& own = under ? below_ : above_;
  std::optional<Seen>& other = under ? above_ : below_;
  if (other && (under ? other->along_mm <= now.along_mm : other->along_mm >= now.along_mm)) other.reset();
  turns_ = under ? std::max(turns_, 0) + 1 : std::min(turns_, 0) - 1;
  own = now;
}

void ForceSeeker::note(const Seen& now) {
  const double way_mm = now.along_mm - last_.along_mm;
  const bool moved = std::abs(way_mm) > 1e-3;
  if (moved) rise_N_mm_ = (now.force_N - last_.force_N) / way_mm;
  last_ = now;
  // A bar that has not met the liver yet has nothing to slip from.
  if (now.force_N > best_.force_N || best_.force_N <= least_N || asked_N_ <= now.force_N) {
    best_ = now;
    slips_ = false;
  }
  slips_ = slips_ || now.along_mm > farthest_mm ||
           (now.along_mm > best_.along_mm + 1.0 && now.force_N < ContactSolver::slipFall * best_.force_N) ||
           now.along_mm > best_.along_mm + slipTravel_mm;
  if (now.settled) enclose(now);
}

double ForceSeeker::backFromSlip(const Seen& now) {
  goal_mm_ = above_->along_mm * asked_N_ / above_->force_N;
  if (now.along_mm > above_->along_mm + 1e-3) return goal_mm_;
  returns_ = false;
  last_ = now;
  return goal_mm_;
}

/// Between a smaller and a larger force: by the rise that was seen last, by the line between both, or in the middle
/// where these have moved the same end again and again.
double ForceSeeker::within(const Seen& now) {
  constexpr int most = 4;
  if (!now.settled) return goal_mm_;
  const double width_mm = above_->along_mm - below_->along_mm;
  if (width_mm < narrowest_mm) {
    nearest_ = true;
    return now.along_mm;
  }
  const double line_N_mm = (above_->force_N - below_->force_N) / width_mm;
  double to_mm = rise_N_mm_ > softest_N_mm
                     ? now.along_mm + (asked_N_ - now.force_N) / rise_N_mm_
                     : below_->along_mm + (asked_N_ - below_->force_N) / std::max(line_N_mm, 1e-12);
  if (std::abs(turns_) > most) to_mm = 0.5 * (below_->along_mm + above_->along_mm);
  return std::clamp(to_mm, below_->along_mm + edge * width_mm, above_->along_mm - edge * width_mm);
}

double ForceSeeker::next(double asked_N, const Seen& now) {
  if (asked_N != asked_N_) ask(asked_N);
  if (returns_) return backFromSlip(now);
  if (now.still) note(now);
  const auto to = [&](double along_mm) {
    const double step_mm = along_mm - now.along_mm;
    if (std::abs(step_mm) > 0.0) step_mm_ = step_mm;
    return goal_mm_ = along_mm;
  };
  if (slips_ || reached(now.force_N)) return to(now.along_mm);
  if (below_ && above_) return to(within(now));
  const double off_N = asked_N - now.force_N;
  // Gone too far, or for long without a force that can be believed: the liver follows first.
  if (!now.settled && off_N * step_mm_ < 0.0) return to(now.along_mm);
  if (!now.still && std::abs(now.along_mm - last_.along_mm) > unseen_mm) return to(now.along_mm);
  const double step_mm = off_N / std::max(rise_N_mm_, softest_N_mm);
  if (std::abs(off_N) > close * std::abs(asked_N)) return to(now.along_mm + step_mm);
  if (!now.still) return to(now.along_mm);
  return to(now.along_mm + std::clamp(step_mm, -closeStep_mm, closeStep_mm));
}

}  // namespace glisson::retraction
