// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mechanics/contact/equilibrium.h"
#include "retraction/body.h"
#include "retraction/rigid_contact.h"
#include "retraction/simulate.h"
#include "uncertainty/elastogram.h"
#include "uncertainty/sources.h"

namespace glisson::uncertainty {

/// A liver with one stiffness, as it was retracted by a rigid bar.
struct Retracted {
  const retraction::Model& model;
  const retraction::Result& result;  ///< an answer, in contact
  bool shearKnown = true;  ///< its shear modulus is what is known, not Young's: it stays where Poisson's ratio moves
};

/// Places of the tissue that are followed, in this order: landmarks, samples of the surface under the bar, cells.
struct Places {
  std::vector<std::size_t> landmark;        ///< those inside the body, by their number
  std::vector<Eigen::Vector3d> landmark_m;  ///< grid axes
  std::vector<std::size_t> sample;          ///< under the bar at the end of either run, by their number
  std::vector<double> sample_mm2;           ///< their areas
  std::size_t cells = 0;

  std::size_t count() const { return landmark.size() + sample.size() + cells; }
};

/// Where the stiffness that moves a figure lies, by the derivative of the figure by every cell's ln modulus.
struct Leverage {
  double per10percent_mm = 0;  ///< what the figure moves by if all of the tissue is 10 % stiffer
  double half_mL = 0;          ///< least volume of tissue that holds half of the sum of absolute derivatives
  double halfWithin_mm = 0;    ///< of the middle of the contact, at rest: the tissue that holds half of that sum
};

/// A retraction with its equilibrium in hand.
class OneStiffness {
 public:
  /// setup: of the run, with the bar where it was placed. Throws BadArgument where the result is no answer in contact.
  OneStiffness(const Retracted& retracted, const retraction::Setup& setup);

  mechanics::Equilibrium& equilibrium() { return *equilibrium_; }
  const mechanics::ContactProblem& problem() const { return scene_.problem; }
  const std::vector<double>& growth_Pa_m() const { return growth_Pa_m_; }
  double surface_m2() const;
  /// Along the bar, and across bar and hoist, unit, grid axes.
  Eigen::Vector3d along() const;
  /// Turns a vector from grid axes to LPS.
  Eigen::Matrix3d toLps() const;
  /// Values of the cells, in the order of the places, on the model's grid; not a number outside the body.
  image::ScalarVolume onGrid(const std::vector<float>& perCell) const;

  /// Landmarks in the body and samples under the bar; other: the second retraction, or null.
  Places places(const std::vector<Eigen::Vector3d>& landmarks_mm, const Retracted* other) const;
  /// Displacement of the places, 3 × count, mm, grid axes.
  Eigen::VectorXf displacements(const Places& places) const;
  Eigen::VectorXf displacements(const Places& places, const mechanics::EquilibriumMotion& motion) const;
  /// Of a figure that moves by `figure`, in m, with this liver's stiffness. Nothing where
  /// mechanics::Equilibrium::gradientByModuli gives nothing.
  std::optional<Leverage> leverage(const mechanics::MotionWeights& figure, const Places& places) const;
  /// The changed problem solved from rest, path and all, and the motion from the answer at hand to that one. found is
  /// false where it has no answer: the bar slips, or the solver stops.
  mechanics::EquilibriumMotion fromRest(const mechanics::Change& change, const Progress& progress) const;
  /// An error of the ln modulus of every cell of the problem (x fastest), of the given seed: noise everywhere, and more
  /// where the elastogram was filled in, as it was beyond the model's own cells.
  std::vector<double> noiseField(const Elastogram& elastogram, const Spreads& spreads, std::uint64_t seed) const;

 private:
  Eigen::VectorXf gathered(const Places& places, const mechanics::NodalField& u_m,
                           const Eigen::Matrix3Xd& surface_u_m) const;

  const Retracted retracted_;
  retraction::Body body_;
  retraction::ContactScene scene_;
  std::vector<double> growth_Pa_m_;
  std::unique_ptr<mechanics::Equilibrium> equilibrium_;
};

}  // namespace glisson::uncertainty
