// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "uncertainty/one_stiffness.h"
#include "uncertainty/sources.h"

namespace glisson::uncertainty {

/// Both ends of an interval of 95 %.
struct Interval {
  double low = 0.0, high = 0.0;
};

/// A vessel landmark, mm.
struct LandmarkSpread {
  std::size_t landmark = 0;                ///< its number
  double sd_mm = 0.0;                      ///< root mean square length of the error of its place, measured stiffness
  std::optional<double> textbook_sd_mm;    ///< the same, textbook stiffness
  std::optional<double> difference_sd_mm;  ///< of the distance between the two
  std::optional<Interval> difference95_mm;
  std::optional<double> beyond;                         ///< probability that the distance is 5 mm or more
  Eigen::Matrix3d place_mm2 = Eigen::Matrix3d::Zero();  ///< covariance of the error of its place, LPS; trace: sd²
};

/// The figures of the difference of all landmarks together.
struct VesselHeadline {
  Interval mean_mm, max_mm;
  Interval beyond;              ///< share of the landmarks that lie 5 mm or more apart
  std::size_t furthest = 0;     ///< number of the landmark that lies furthest apart
  double furthest_mm = 0.0;     ///< how far
  Interval furthest95_mm;       ///< of that landmark
  double furthestBeyond = 0.0;  ///< probability that it is 5 mm or more
};

/// The figures of the difference.
struct Headline {
  Interval mean_mm, at_retractor_mm, travel_mm;
  std::optional<VesselHeadline> vessels;  ///< where there are landmarks
  double beyond = 0.0;                    ///< probability that the difference at the retractor is 5 mm or more
  double travelBeyond = 0.0;              ///< the same of the travel of the bar, either way
  double withinVoxel = 0.0;               ///< probability that the mean difference is at most one voxel of the MRI
};

/// One source's share: standard deviations with the others left out.
struct SourceSpread {
  SourceKind kind{};
  double sd_mm = 0.0;         ///< of the difference at the retractor; without a comparison of the vessels' places (rms)
  double mean_sd_mm = 0.0;    ///< of the mean difference
  double travel_sd_mm = 0.0;  ///< of the bar's travel (difference, or measured)
  double vessels_sd_mm = 0.0;   ///< rms over the landmarks: error of their places, measured stiffness
  double furthest_sd_mm = 0.0;  ///< of the difference at VesselHeadline::furthest; 0 without a comparison
};

/// Displacements of the places to first order: base + gain z, z standard normal. mm, grid axes.
struct FirstOrder {
  Places places;
  std::vector<SourceKind> kind;                ///< per column
  std::size_t fields = 0;                      ///< the first columns: random elastograms, each over √fields
  Eigen::VectorXf measured, textbook;          ///< 3 × places; textbook empty: no comparison
  Eigen::MatrixXf measuredGain, textbookGain;  ///< 3 × places by columns
  double travel_mm = 0.0, textbookTravel_mm = 0.0;
  Eigen::VectorXd travelGain, textbookTravelGain;       ///< mm per column
  Eigen::Matrix3d toLps = Eigen::Matrix3d::Identity();  ///< of a vector in grid axes
};

/// Intervals of the landmarks and figures, and what drives them.
struct Spread {
  std::vector<LandmarkSpread> landmarks;
  std::optional<Headline> headline;
  std::vector<SourceSpread> sources;
  std::vector<float> cellBeyond;  ///< per cell: probability that the difference is 5 mm or more; with a comparison
};

/// Figures of the difference at displacements of the places (3 × places, mm).
struct Figures {
  double at_retractor_mm = 0.0, mean_mm = 0.0;
};
Figures figuresOf(const Places& places, const Eigen::VectorXf& measured, const Eigen::VectorXf& textbook);

/// Draws all sources `draws` times and takes lengths draw by draw, so that a difference near 0 has no negative half.
/// Intervals run from the 2.5th to the 97.5th percentile; those of lengths are joined with their reflection at the
/// length at hand. As the covariance of the elastogram comes from few fields, its part of a draw is scaled as Student's
/// t is. The same bits for the same seed, with any number of threads.
Spread sampled(const FirstOrder& first, const std::vector<FurtherErrors>& further, int draws, std::uint64_t seed);

}  // namespace glisson::uncertainty
