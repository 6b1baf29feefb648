// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/run.h"
#include "retraction/body.h"
#include "study/detail/methods.h"
#include "study/detail/tradeoff_variants.h"
#include "study/tradeoff.h"

namespace glisson::study {

inline constexpr const char* rigidBarMethod = "Rigid bar, large deformation";

/// The runs of a trade-off study: bodies by cell size, each made once, and a row for each variant.
class TradeoffRuns {
 public:
  /// points: LPS mm; truth: the reference's displacements there, mm. inputs, own (the scene's own model) and study
  /// outlive it.
  TradeoffRuns(pipeline::Scene scene, const pipeline::Inputs& inputs, const retraction::Model& own,
               std::vector<Eigen::Vector3d> points, std::vector<Eigen::Vector3d> truth, TradeoffStudy& study);

  /// Adds the variant's row, or says why there is none. Throws Cancelled.
  void run(const Variant& v, const Progress& progress);

  /// The rigid bar in large deformation on cells of this size, against the same on the reference's cells: `truth`.
  /// Throws Cancelled.
  void runBar(double factor, const retraction::Setup& setup, const std::vector<Eigen::Vector3d>& truth,
              const std::string& reference, const Progress& progress);

 private:
  /// The scene's body in cells of one size.
  struct Case {
    retraction::Model model;
    std::unique_ptr<retraction::Body> body;
    retraction::MechanicsScene scene;
    std::string failed;  ///< why there is none
    std::string sameAs;  ///< the size that came to the same grid
  };

  Case& at(double factor, const Progress& progress);
  /// Through the whole retraction step: tetrahedra, and scenes that move or are not linear.
  Measured simulated(const Variant& v, const Case& c, const Progress& progress) const;
  Measured measured(const Variant& v, const Case& c, const Progress& progress) const;
  std::vector<Eigen::Vector3d> atPoints(const Case& c, const mechanics::NodalField& u_m) const;
  /// What the solver alone leaves: the distance from the exact answer of the same cells.
  void noteSolver(const Variant& v, const Measured& m, const std::vector<Eigen::Vector3d>& u, Row& row);
  Row answer(const Variant& v, Case& c, const Progress& progress);

  pipeline::Scene scene_;
  const pipeline::Inputs& inputs_;
  const retraction::Model& own_;
  std::vector<Eigen::Vector3d> points_, truth_;
  std::vector<Eigen::Vector3d> exact_;  ///< of the scene's own cells
  TradeoffStudy& study_;
  std::map<double, Case> cases_;
};

}  // namespace glisson::study
