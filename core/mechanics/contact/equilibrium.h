// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "mechanics/contact/change.h"

namespace glisson::mechanics {

/// How a body and its bar move when something of their problem changes.
struct EquilibriumMotion {
  NodalField u_m;                ///< 3 × nodes of VoxelMesh(body), grid axes
  Eigen::Matrix3Xd surface_u_m;  ///< 3 × samples of the problem's surface
  double travel_m = 0;           ///< of the bar along its hoist
  bool found = false;            ///< false: the rest is not to be used
  int iterations = 0;            ///< conjugate gradients, or Newton's
};

/// A figure that is linear in a motion: the weights of its displacements and of the travel. Empty arrays count nothing.
struct MotionWeights {
  NodalField node;           ///< 3 × nodes of VoxelMesh(body)
  Eigen::Matrix3Xd surface;  ///< 3 × samples of the problem's surface
  double travel = 0;

  double of(const EquilibriumMotion& motion) const;
};

/// An equilibrium that solveContact has found, taken up again on the body's own cells: the exact tangent there, and
/// what small changes of the problem do. With r(u, s; p) the gradient of the potential by displacements u and travel s,
/// r = 0 gives δ(u, s) = −K⁻¹ ∂r/∂p δp, K the tangent with contact. Where the travel is given, s does not move.
/// Derivatives ∂r/∂p are exact but for the bar's and the surface's, which are central differences of the contact
/// forces.
class Equilibrium {
 public:
  /// ∂r/∂p δp: N per displacement (three arrays of node slots), and one more for the travel.
  using Unbalance = std::vector<double>;

  /// u_m, travel_m: as ContactSolution has them for this problem and these options;
  /// barStart_m: first point of the bar's centre line at travel 0 (ContactSolution::bar), where loads have moved the
  /// body before the bar came; else the bar starts at its first force on the body at rest.
  Equilibrium(const ContactProblem& problem, const ContactOptions& options, const NodalField& u_m, double travel_m,
              const std::optional<Eigen::Vector3d>& barStart_m = {});
  ~Equilibrium();
  Equilibrium(Equilibrium&&) noexcept;

  /// False where the tangent could not be prepared.
  bool usable() const;
  double residual() const;  ///< ‖r‖ over the load
  /// The bar at travel 0.
  const RigidBar& bar() const;

  /// ∂r/∂p δp of a change, taken to be small: first order in every entry, ln of the moduli included. Turns of the bar
  /// are about the change's pivot. Entries of logModuli lie above −7.
  Unbalance by(const Change& change) const;
  Unbalance left() const;  ///< r itself: what the solver has left over

  /// −K⁻¹ unbalance to ‖residual‖ ≤ tolerance ‖unbalance‖; where bar or surface move, nearly all of that is contact
  /// forces that cancel, and 1e-6 gives .1 % of the motion (1e-3 half of it). found is false where the tangent has a
  /// direction of no or negative curvature, or the limit is reached.
  EquilibriumMotion respond(const Unbalance& unbalance, double tolerance = 1e-3, int limit = 400);

  /// What a figure moves by for each cell's ln Young's modulus (x fastest, 0 in empty cells), by one adjoint solve:
  /// −(K⁻¹ w) · ∂r/∂ ln E_c, w the weights; the figure's unit. The sum over cells times their change of ln E is what
  /// respond() says of it. Nothing where loads that follow their faces make K unsymmetric, or respond() would find
  /// none.
  std::optional<std::vector<double>> gradientByModuli(const MotionWeights& figure, double tolerance = 1e-6,
                                                      int limit = 800);

  /// The equilibrium of the changed problem, by Newton's method from here (from `guess` ahead, where that is given and
  /// feasible); the motion to it, travel seen from the present bar. found is false where none is found near.
  EquilibriumMotion afterwards(const Change& change, const EquilibriumMotion* guess, double tolerance,
                               const Progress& progress) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glisson::mechanics
