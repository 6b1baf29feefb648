// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "mechanics/dynamics.h"

namespace glisson::mechanics {

/// One motion, step by step: what integrate does between two looks at it. Kept apart into the system's free modes and
/// the rest, which is M-orthogonal to them.
class TimeStepper {
 public:
  /// Energies and unbalance before a step.
  struct Seen {
    double kinetic_J = 0, elastic_J = 0, unbalance_N = 0;  ///< ‖f − K q‖
  };

  /// Prepares the system for steps of h (s). f: the full load, N; factor: of it at the start.
  TimeStepper(DynamicSystem& system, const Eigen::VectorXd& f, const Eigen::VectorXd& q0, const Eigen::VectorXd& v0,
              double h, const DynamicOptions& options, double factor);
  /// To be called before every step.
  Seen see(double factor);
  /// Under the load's factors at the step's start and end; writes q, v and a of the state. A report that is not finite
  /// leaves the motion and the state as they were.
  SolveReport step(double from, double to, DynamicState& state);

 private:
  /// Weights of a scheme in integrate's notation.
  struct Scheme {
    bool euler = true;
    double am = 0, af = 0, gamma = 1, beta = 1;
    explicit Scheme(const DynamicOptions& options);
  };

  SolveReport stepEuler(double to, DynamicState& state);
  SolveReport stepSecondOrder(double from, double to, DynamicState& state);
  SolveReport solve(Eigen::VectorXd& b);
  void accelerate(double factor);
  void withoutModes(Eigen::VectorXd& x) const;
  void withoutRigidForce(Eigen::VectorXd& b) const;
  void write(DynamicState& state) const;

  DynamicSystem& system_;
  const Eigen::VectorXd& f_;
  Scheme scheme_;
  double h_, alpha_, damp_;
  Eigen::MatrixXd R_, MR_;                           ///< n × modes
  Eigen::VectorXd q_, v_, a_;                        ///< of the rest
  Eigen::VectorXd distance_, speed_, acceleration_;  ///< of the modes
  Eigen::VectorXd Kq_, Mv_, x_;
  bool impulseKnown_ = false;  ///< M v of the last step is Mv_ − (h + β) K q / (1 + h α), with the K q that it leads to
};

}  // namespace glisson::mechanics
