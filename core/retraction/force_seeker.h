// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace glisson::retraction {

/// Leads a bar, frame by frame, to the travel at which the liver bears a force. Goes by the rise of the force between
/// states near equilibrium, never by the force itself, so that a bar that slips is met as one; once a smaller and a
/// larger force were met, by the bracket of the two.
class ForceSeeker {
 public:
  /// Bar and liver after a frame.
  struct Seen {
    double along_mm = 0.0;  ///< travel of the bar along the hoist, from its first touch
    double force_N = 0.0;   ///< of the bar on the liver, along the hoist
    bool still = true;      ///< the liver is near equilibrium: the force says something
    bool settled = true;    ///< it is in equilibrium: the force is exact
  };

  static constexpr double met = 3e-3;       ///< of the force asked for
  static constexpr double least_N = 1e-3;   ///< what is told from no force, and from the force asked for
  static constexpr double still_mm = 0.03;  ///< distance from equilibrium below which a liver is near it
  static constexpr double farthest_mm = 200.0;

  /// Where the bar has to go next, mm along the hoist. Where it slips it stays.
  double next(double asked_N, const Seen& now);
  /// The bar was moved by other means: what was seen of forces on the way counts no more.
  void forget(const Seen& now);
  /// The liver does not bear the force that was asked for last.
  bool slips() const { return slips_; }
  /// Whether a force is the one asked for, or as near to it as the bar can be led.
  bool reached(double force_N) const;

 private:
  void ask(double asked_N);
  void note(const Seen& now);
  void enclose(const Seen& now);
  double within(const Seen& now);
  double backFromSlip(const Seen& now);

  double asked_N_ = 0.0;
  Seen last_;               ///< the last one near equilibrium
  Seen best_;               ///< largest force on the way, and where
  double rise_N_mm_ = 0.0;  ///< of the force with travel between the last two near equilibrium
  double goal_mm_ = 0.0, step_mm_ = 0.0;
  std::optional<Seen> below_, above_;  ///< settled, on either side of the force asked for
  int turns_ = 0;                      ///< how often the same end of the bracket was moved, signed
  bool slips_ = false, returns_ = false, nearest_ = false;
};

}  // namespace glisson::retraction
