// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/quantity.h"

namespace glisson::uncertainty {

/// What is uncertain, as standard deviations. 0 leaves a source out.
struct Spreads {
  /// Of one examination against another, relative: repeatability coefficient 19 % = 1.96 √2 within-subject coefficients
  /// of variation [qiba2022mre].
  double repeatability = 0.19 / 2.772;
  double noise = -1.0;  ///< of a voxel's ln modulus within an examination; negative: from the map (noiseOf)
  double correlation_mm =
      10.0;  ///< distance at which that noise is correlated by 1/e: the size of an inversion's window
  double fillCorrelation_mm = 30.0;  ///< the same of what was filled in where the elastogram says nothing
  double outline_mm = 1.0;   ///< of the whole outline, outwards: mean distance of two readers [heimann2009comparison]
  double poisson = 0.02;     ///< own estimate: .41 to .49
  double supports = 0.4;     ///< of ln stiffness of bed, springs and ligaments; own estimate: a factor of 2 either way
  double capsule = 0.41;     ///< of ln tension: 8.2 ± 3.4 MPa [umale2011characterization]
  double force = 0.1;        ///< relative; own estimate
  double density = 0.02;     ///< relative, where the bar bears the liver's weight; own estimate
  double barPlace_mm = 5.0;  ///< along the bar and across it; own estimate
  double barTurn_deg = 5.0;  ///< about each of three axes; own estimate
};

/// What the scene asks for.
struct Options {
  Spreads spreads;
  int fields = 32;          ///< random elastograms that are pushed through
  int checks = 2;           ///< random combinations of all sources that are solved in full
  int draws = 2000;         ///< of the combined sources
  double tolerance = 1e-3;  ///< of the linear solves, relative
};

/// A source in words.
struct SourceWords {
  std::string name;       ///< as in JSON
  std::string spread;     ///< its standard deviation and what of
  std::string reference;  ///< key in REFERENCES.bib, or "own estimate"
};

/// Kinds of sources, in the order in which they are told.
enum class SourceKind {
  ElastogramNoise,
  ElastogramRepeatability,
  Outline,
  Poisson,
  Supports,
  Capsule,
  Force,
  Density,
  BarPlace,
  BarDirection,
  Cells,
  Kinematics,
  Solver,
  BeyondFirstOrder
};

/// A source whose errors are known as they are, not through changes of the problem: root mean squares, mm.
struct FurtherErrors {
  SourceKind kind{};
  double place_mm = 0.0;                                         ///< length of the error of a displacement
  double difference_mm = 0.0;                                    ///< the same of a difference, at one place
  double at_retractor_mm = 0.0, mean_mm = 0.0, travel_mm = 0.0;  ///< of the figures of the difference
  double place = 0.0, difference = 0.0;  ///< at one place, in shares of what the first order spreads there
};

/// noise: the one used, where Spreads asks for that of the map.
SourceWords wordsOf(SourceKind kind, const Spreads& spreads, double noise);

}  // namespace glisson::uncertainty
