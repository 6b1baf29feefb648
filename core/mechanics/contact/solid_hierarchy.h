// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "base/progress.h"
#include "mechanics/contact/solid_level.h"

namespace glisson::mechanics {

/// How a solve with the tangent ended.
enum class TangentOutcome { Converged, Indefinite, Limit };

/// How a solve with the tangent went.
struct TangentSolve {
  TangentOutcome outcome = TangentOutcome::Limit;
  int iterations = 0;
};

/// A body under large deformation on nested grids: any level can be the finest of a solve, so that a path is followed
/// on coarse cells and only its end on fine ones. Multigrid is rebuilt on the positive part of the tangent at each
/// linearisation; coarse levels linearise at the mean displacement of the nodes they stand for.
class SolidHierarchy {
 public:
  /// finest: with its fixed degrees of freedom, springs and points set. Coarser levels follow until few nodes are left.
  explicit SolidHierarchy(SolidLevel finest);

  SolidLevel& level(std::size_t l) { return levels_[l]; }
  const SolidLevel& level(std::size_t l) const { return levels_[l]; }
  std::size_t levels() const { return levels_.size(); }

  /// Follower pressures of the next linearise(), in the exact tangent of its top level only.
  void setFollowers(std::vector<FollowerStiffness> followers) { followers_ = std::move(followers); }
  /// A skin on the surface, on all levels; cells: of the finest level.
  void setSkin(const std::vector<SkinSample>& samples, const Skin& skin);
  /// Points of the surface on all levels: cell of the finest level and place (m).
  void setPoints(const std::vector<Eigen::Vector3i>& cells, const std::vector<Eigen::Vector3d>& places_m);

  /// Tangent of levels `top` and coarser at u (3 nodes of level top, m). False where the coarsest level has no factor.
  bool linearise(std::size_t top, SolidLaw law, const double* u, const std::vector<PointStiffness>& contact,
                 bool travels, const Eigen::Vector3d& hoist);
  /// x ≈ (exact tangent)⁻¹ b by conjugate gradients to ‖r‖ ≤ tolerance ‖b‖, arrays of level top's size(). Indefinite:
  /// a direction of no or negative curvature was met; x is the answer so far, at the first iteration that direction. In
  /// float; b is scaled to its largest entry inside.
  TangentSolve solve(std::size_t top, const std::vector<double>& b, std::vector<double>& x, double tolerance, int limit,
                     bool positive);
  /// The same by GMRES with the exact tangent, which need not be symmetric; it ends as Converged or Limit.
  TangentSolve solveUnsymmetric(std::size_t top, const std::vector<double>& b, std::vector<double>& x, double tolerance,
                                int limit);
  /// u on level l from its parent level's, m.
  std::vector<double> prolonged(std::size_t l, const std::vector<double>& coarse) const;

 private:
  bool factorise();
  void cycle(std::size_t l);
  bool precondition(std::size_t top, const std::vector<float>& r, std::vector<float>& z, double& rz);

  std::vector<SolidLevel> levels_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  std::vector<std::size_t> coarsestDofs_;
  std::vector<FollowerStiffness> followers_;
};

}  // namespace glisson::mechanics
