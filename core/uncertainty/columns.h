// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "uncertainty/one_stiffness.h"
#include "uncertainty/sources.h"

namespace glisson::uncertainty {

/// A retraction by a rigid bar, as it was answered, and what is uncertain of it. The textbook stiffness is exact by
/// definition: it is what one would have assumed. All that both retractions share changes in both at once.
struct Case {
  Retracted measured;
  std::optional<Retracted> textbook;
  const retraction::Setup& setup;  ///< with the bar where it was placed
  const std::vector<Eigen::Vector3d>& landmarks_mm;
  std::optional<Elastogram> elastogram;  ///< empty: the stiffness was not measured, and is taken as exact
  std::vector<FurtherErrors> further;    ///< estimates of other steps
  std::vector<std::size_t> tips{};       ///< landmarks at the ends of vessels, by their numbers
};

/// The change of one standard deviation of a source, or of one of its independent parts.
struct Column {
  SourceKind kind{};
  mechanics::Change measured;                 ///< nothing: Solver
  std::optional<mechanics::Change> textbook;  ///< empty: it does not change
};

/// All columns, by kind in the order of SourceKind. Random elastograms are divided by √fields, so that together they
/// have the covariance of one. textbook: null without a comparison.
std::vector<Column> columnsOf(OneStiffness& measured, OneStiffness* textbook, const Case& patient,
                              const Options& options, std::uint64_t seed);

/// Σ factor × change of the columns, of the measured or the textbook retraction. Turns add up, as if they were small.
mechanics::Change sumOf(const std::vector<Column>& columns, const Eigen::VectorXd& factor, bool textbook);

}  // namespace glisson::uncertainty
