// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/time_stepper.h"

namespace glisson::mechanics {

TimeStepper::Scheme::Scheme(const DynamicOptions& o) : euler(o.scheme == TimeScheme::ImplicitEuler) {
  if (euler) return;
  if (o.scheme == TimeScheme::GeneralisedAlpha) {
    am = (2 * o.spectralRadius - 1) / (o.spectralRadius + 1);
    af = o.spectralRadius / (o.spectralRadius + 1);
  }
  gamma = 0.5 - am + af;
  beta = 0.25 * (1 - am + af) * (1 - am + af);
}

TimeStepper::TimeStepper(DynamicSystem& system, const Eigen::VectorXd& f, const Eigen::VectorXd& q0,
                         const Eigen::VectorXd& v0, double h, const DynamicOptions& options, double factor)
    : system_(system),
      f_(f),
      scheme_(options),
      h_(h),
      alpha_(options.rayleighAlpha_1_s),
      damp_(options.rayleighBeta_s),
      R_(system.freeModes()),
      q_(q0),
      v_(v0),
      Kq_(q0.size()),
      Mv_(q0.size()),
      x_(Eigen::VectorXd::Zero(q0.size())) {
  MR_.resize(R_.rows(), R_.cols());
  Eigen::VectorXd Mr(q_.size());
  for (Eigen::Index c = 0; c < R_.cols(); ++c) {
    system_.applyM(R_.col(c), Mr);
    MR_.col(c) = Mr;
  }
  if (R_.cols() > 0) {
    distance_ = MR_.transpose() * q_;
    speed_ = MR_.transpose() * v_;
    q_ -= R_ * distance_;
    v_ -= R_ * speed_;
  }
  if (scheme_.euler) {
    x_ = v_;
    system_.prepare(1.0 + h_ * alpha_, h_ * (h_ + damp_));
    return;
  }
  accelerate(factor);
  const double share = 1 - scheme_.af;
  system_.prepare(1 - scheme_.am + share * scheme_.gamma * h_ * alpha_,
                  share * (scheme_.gamma * h_ * damp_ + scheme_.beta * h_ * h_));
}

/// M a = f − C v − K q at the start.
void TimeStepper::accelerate(double factor) {
  Eigen::VectorXd K(q_.size()), M(q_.size());
  system_.applyK(q_ + damp_ * v_, K);
  system_.applyM(v_, M);
  Eigen::VectorXd b = factor * f_ - K - alpha_ * M;
  withoutRigidForce(b);
  a_ = Eigen::VectorXd::Zero(q_.size());
  if (b.squaredNorm() > 0) {
    system_.prepare(1, 0);
    system_.solve(b, a_);
    withoutModes(a_);
  }
  if (R_.cols() > 0) acceleration_ = factor * (R_.transpose() * f_) - alpha_ * speed_;
}

void TimeStepper::withoutModes(Eigen::VectorXd& x) const {
  if (R_.cols() > 0) x -= R_ * (MR_.transpose() * x).eval();
}

void TimeStepper::withoutRigidForce(Eigen::VectorXd& b) const {
  if (R_.cols() > 0) b -= MR_ * (R_.transpose() * b).eval();
}

TimeStepper::Seen TimeStepper::see(double factor) {
  system_.applyK(q_, Kq_);
  if (impulseKnown_)
    Mv_ -= ((h_ + damp_) / (1.0 + h_ * alpha_)) * Kq_;
  else
    system_.applyM(v_, Mv_);
  impulseKnown_ = false;
  return {0.5 * (v_.dot(Mv_) + speed_.squaredNorm()), 0.5 * q_.dot(Kq_), (factor * f_ - Kq_).norm()};
}

SolveReport TimeStepper::step(double from, double to, DynamicState& state) {
  return scheme_.euler ? stepEuler(to, state) : stepSecondOrder(from, to, state);
}

/// x of the step's matrix, without the modes; its status says where it is not finite.
SolveReport TimeStepper::solve(Eigen::VectorXd& b) {
  withoutRigidForce(b);
  SolveReport report = system_.solve(b, x_);
  if (x_.allFinite())
    withoutModes(x_);
  else
    report.status = SolveStatus::NotFinite;
  return report;
}

SolveReport TimeStepper::stepEuler(double to, DynamicState& state) {
  // For the velocity itself: M v₊ + h C v₊ + h² K v₊ = M v + h (f − K q), with the load at the end of the step, as
  // every other force in the implicit scheme.
  Eigen::VectorXd b = Mv_ + h_ * (to * f_ - Kq_);
  const SolveReport report = solve(b);
  if (report.status == SolveStatus::NotFinite) return report;
  // The step's own equation has M v₊, since h K v₊ is the change of K q: (1 + h α) M v₊ = b − (h + β) (K q₊ − K q).
  // What its solver left undone stays in it, and is done by the next step.
  impulseKnown_ = report.converged() && R_.cols() == 0;
  if (impulseKnown_) Mv_ = (b + (h_ + damp_) * Kq_) / (1.0 + h_ * alpha_);
  a_ = (x_ - v_) / h_;
  v_ = x_;
  q_ += h_ * v_;
  if (R_.cols() > 0) {
    const Eigen::VectorXd gain = (h_ / (1 + h_ * alpha_)) * (R_.transpose() * (to * f_) - alpha_ * speed_);
    speed_ += gain;
    distance_ += h_ * speed_;
    acceleration_ = gain / h_;
  }
  write(state);
  return report;
}

SolveReport TimeStepper::stepSecondOrder(double from, double to, DynamicState& state) {
  const auto [euler, am, af, gamma, beta] = scheme_;
  const double load = (1 - af) * to + af * from;
  // What velocity and displacement at the step's own moment are without the new acceleration.
  const Eigen::VectorXd v = v_ + (1 - af) * h_ * (1 - gamma) * a_;
  const Eigen::VectorXd q = q_ + (1 - af) * (h_ * v_ + h_ * h_ * (0.5 - beta) * a_);
  Eigen::VectorXd K(q_.size()), M(q_.size());
  system_.applyK(q + damp_ * v, K);
  system_.applyM(am * a_ + alpha_ * v, M);
  Eigen::VectorXd b = h_ * (load * f_ - K - M);
  const SolveReport report = solve(b);
  if (report.status == SolveStatus::NotFinite) return report;
  const Eigen::VectorXd a = x_ / h_;
  q_ += h_ * v_ + h_ * h_ * ((0.5 - beta) * a_ + beta * a);
  v_ += h_ * ((1 - gamma) * a_ + gamma * a);
  a_ = a;
  if (R_.cols() > 0) {
    const Eigen::VectorXd s = speed_ + (1 - af) * h_ * (1 - gamma) * acceleration_;
    const Eigen::VectorXd next =
        (load * (R_.transpose() * f_) - am * acceleration_ - alpha_ * s) / (1 - am + (1 - af) * alpha_ * h_ * gamma);
    distance_ += h_ * speed_ + h_ * h_ * ((0.5 - beta) * acceleration_ + beta * next);
    speed_ += h_ * ((1 - gamma) * acceleration_ + gamma * next);
    acceleration_ = next;
  }
  write(state);
  return report;
}

void TimeStepper::write(DynamicState& state) const {
  state.a = a_;
  state.v = v_;
  state.q = q_;
  if (R_.cols() == 0) return;
  state.a += R_ * acceleration_;
  state.v += R_ * speed_;
  state.q += R_ * distance_;
}

}  // namespace glisson::mechanics
