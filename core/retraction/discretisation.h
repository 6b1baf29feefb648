// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "retraction/simulate.h"

namespace glisson::retraction {

/// How far a result may be from that of infinitely small cells.
struct DiscretisationError {
  bool known = false;   ///< false: the body is too coarse to be halved; see note
  double max_mm = 0.0;  ///< over the cells
  double p95_mm = 0.0;  ///< 95 % of the cells are below
  double mean_mm = 0.0;
  /// Mean over the nodes of the contact, as comparison::Difference has it; of a rigid bar that a force drives at least
  /// what its travel is off by.
  std::optional<double> at_retractor_mm;
  std::optional<double> vessels_mm, vesselsMax_mm;  ///< over the landmarks: mean, largest
  double cell_mm = 0.0, coarse_mm = 0.0;            ///< largest cell edge of the result's grid and of the other
  std::string note;                                 ///< in words, for reports

  /// Of the difference of two answers, |error of the one − error of the other|: what their cells have in common
  /// cancels.
  struct OfDifference {
    double mean_mm = 0.0;                             ///< over the cells
    std::optional<double> at_retractor_mm;            ///< mean over the nodes of the contact
    std::optional<double> vessels_mm, vesselsMax_mm;  ///< over the landmarks: mean, largest
  };
  std::optional<OfDifference> difference;  ///< where there is a second answer, and its error is known
};

/// A second stiffness of the same body under the same load, with its answer.
struct SecondAnswer {
  const Model& model;
  const Result& result;
};

/// The same body in cells of twice the edge: a coarse cell is filled where at least half of its eight are, with the
/// mean modulus of those that are. Throws BadInput where none is.
retraction::Model coarsened(const retraction::Model& model);

/// The same body, every cell split into eight.
retraction::Model refined(const retraction::Model& model);

/// The setup with what depends on resolution held: each retractor stays at the contact of `result` and keeps its force.
retraction::Setup held(const retraction::Setup& setup, const retraction::Model& model,
                       const retraction::Result& result);

/// Estimate from two grids, cells and twice the cells: |u_h − u_2h|, which is the error of u_h where it falls with
/// first order, as staircase surfaces and clamped edges make it, and (2^p − 1) times the error where it falls with
/// order p: up to three times for linear shape functions, up to seven times for quadratic ones. A body of at most
/// 20,000 voxels that cannot be merged two by two without changing its shape is split instead: 2 |u_h − u_h/2|, the
/// same to first order; so is one of which more than half the cells lie in a run of at most three from surface to
/// surface, whose merged cells would be too few to bend; where such a body is larger, or not of linear hexahedra, the
/// error is unknown. It is unknown too for elements that lock, plain hexahedra and linear tetrahedra at a Poisson's
/// ratio above .49: the note then has the distance from B-bar hexahedra on the same cells, which for incompatible modes
/// above .499 is added. Delaunay tetrahedra that fail their gates at twice the edge are made 1.75 or 1.5 times as
/// large, and the difference divided by ratio − 1. For a mesh-free result the distance from the voxel FEM on its own
/// cells is added. Costs one solve with an eighth of the cells (mesh-free: one more with all of them), twice that with
/// a second answer. Throws Cancelled; whatever else goes wrong on the coarse grid is told in the note. second: the same
/// is done for it, and the error of the difference told. Contact nodes that lie off the coarse body by more than half
/// of its cells count in no mean, nor do landmarks (LPS) outside the body.
DiscretisationError discretisationError(const retraction::Model& model, const retraction::Setup& setup,
                                        const retraction::Result& result, const Progress& progress = {},
                                        const SecondAnswer* second = nullptr,
                                        const std::vector<Eigen::Vector3d>& landmarks_mm = {});

}  // namespace glisson::retraction
