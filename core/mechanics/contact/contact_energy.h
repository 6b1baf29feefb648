// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "mechanics/contact/barrier.h"
#include "mechanics/contact/contact_solve.h"
#include "mechanics/contact/follower_loads.h"
#include "mechanics/contact/solid_hierarchy.h"

namespace glisson::mechanics {

/// Potential of body, bar and loads on one level of a hierarchy:
/// Π(u, s) = Σ cells + springs + bed + tethers + Σ w φ(g(x_p, s)) − f·u + p V − F s, and its derivatives.
class ContactEnergy {
 public:
  /// surface: the samples that the hierarchy carries, in its order.
  ContactEnergy(const SolidHierarchy& hierarchy, std::vector<SurfaceSample> surface, const ContactProblem& problem,
                const ContactOptions& options);

  /// A state of level `top`: displacements (3 nodes, m) and travel (m).
  struct State {
    std::vector<double> u;
    double s = 0;
  };
  /// Potential, gradient and contact figures at a state.
  struct Value {
    double potential = 0;          ///< J; without the loads that follow where they have none
    std::vector<double> gradient;  ///< size() of the level; the last entry is bar force − F, or 0 where s is given
    double barForce_N = 0;         ///< along the hoist, on the body
    double contact_N = 0;          ///< Σ |force| of all samples
    double deepest_m = 0;          ///< of the samples inside the bar
    double loads_N = 0;            ///< ‖f‖ on the free degrees of freedom
  };

  /// Level, and its dead loads (3 nodes, N; or empty).
  void setLoads(std::size_t top, const std::vector<double>& loads);
  /// False where the law or the contact is not defined (a sample deeper than the guard).
  bool evaluate(const State& at, std::optional<double> force_N, bool travels, Value& value) const;
  /// The same for the bar where it is, at fixed degrees of freedom too: there the gradient is the force of the clamp.
  bool unbalanced(const State& at, Value& value) const;
  /// True where no sample passes through the bar on the straight way from one state to the next.
  bool passes(const State& from, const State& to) const;
  /// True if the bar lies between neighbouring samples of the surface, which have been drawn apart: it has cut into it.
  bool cuts(const State& at) const;
  /// True where a sample lies so deep in the bar that the barrier no longer keeps it out.
  bool deep(const State& at) const;
  std::vector<PointStiffness> stiffness(const State& at) const;
  std::vector<FollowerStiffness> followers(const State& at) const;
  /// Share of the loads that follow their faces; 1 at first.
  void setPressureShare(double share) { pressureShare_ = share; }
  /// False where loads that follow their faces have no potential: the tangent is unsymmetric.
  bool hasPotential() const { return pressures_.empty() || potential_.has_value(); }
  Eigen::Vector3d following_N(const State& at) const;  ///< sum of the loads that follow their faces
  /// Energy of bed and tethers, J; their forces on the body (N) are added to three arrays of nodes, and those of the
  /// tethers given one by one.
  double addHolding(const State& at, double* forces, std::vector<Eigen::Vector3d>& tether_N) const;

  /// The bar is brought to the first force on the body as it is in this state, whose travel does not count.
  void bringToForce(const State& at);
  /// The bar is taken elsewhere, beside its travel.
  void moveBar(const Eigen::Vector3d& by_m);
  /// Of the bar on the body, N.
  Eigen::Vector3d force(const State& at) const;

  const RigidBar& bar() const { return *bar_; }
  bool hasBar() const { return bar_.has_value(); }
  const Barrier& barrier() const { return barrier_; }
  std::size_t top() const { return top_; }
  SolidLaw law() const { return law_; }
  const std::vector<SurfaceSample>& surface() const { return surface_; }
  Eigen::Vector3d place(std::size_t sample, const State& at) const;

 private:
  void addBed(const State& at, Value& value) const;
  void addTethers(const State& at, Value& value) const;
  void addPressures(const State& at, Value& value) const;
  /// f(points, triangle) for the four triangles of a face, each pair of diagonals half.
  template <class F>
  void forTriangles(const State& at, const F& f) const;
  /// The bar is brought from behind to where the barrier begins: there its travel is 0.
  void bringToForce(const std::vector<Eigen::Vector3d>& places_m);
  /// Sorts the samples at rest into cubes as wide as a neighbourhood.
  void sortIntoCubes();
  /// The samples around one on the surface at rest, that look the same way.
  const std::vector<std::uint32_t>& neighboursOf(std::uint32_t sample) const;
  /// The samples that can be in contact in this state: all others are out of the barrier's zone.
  const std::vector<std::uint32_t>& near(const State& at) const;
  /// How far samples and bar can have moved towards each other since `near_` was chosen, from above; m.
  double movedSince(const State& at) const;

  const SolidHierarchy& hierarchy_;
  std::vector<SurfaceSample> surface_;
  /// The samples in a cube of the body at rest, where there is a bar; by cube.
  std::vector<std::pair<std::array<int, 3>, std::uint32_t>> cubes_;
  double neighbourhood_m_ = 0;
  /// Of each sample once it is asked for: few ever come near the bar. Empty until then.
  mutable std::vector<std::optional<std::vector<std::uint32_t>>> neighbours_;
  std::vector<BedSample> bed_;           ///< points behind those of the surface
  std::vector<Tether> tethers_;          ///< points behind those of the bed
  std::vector<FollowerFace> pressures_;  ///< four points each behind those of the tethers
  std::optional<PressurePotential> potential_;
  double pressureShare_ = 1;
  SolidLaw law_;
  std::optional<RigidBar> bar_;
  Barrier barrier_;
  std::size_t top_ = 0;
  std::vector<double> loads_;
  /// Samples that were within reach of the bar in a state of level `top`.
  struct Near {
    std::size_t top = 0;
    State at;
    double barMoved_m = 0;  ///< beside its travel, since
    std::vector<std::uint32_t> samples;
  };
  mutable Near near_;
  mutable std::vector<Gap> gaps_;  ///< of near_.samples
  double spread_ = 1;              ///< largest Σ |weight| of a sample: it moves by no more than this times a node
};

}  // namespace glisson::mechanics
