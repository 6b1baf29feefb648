// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/linear_gap.h"

namespace glisson::retraction {

struct Model;
struct Result;
struct Setup;

/// What linear theory misses of an answer, in mm: the figure that says whether it can be trusted.
struct LinearGap {
  bool known = false;  ///< false: see why
  mechanics::Stability stability = mechanics::Stability::Unknown;
  double mean_mm = 0.0;                    ///< over the cells
  double max_mm = 0.0;                     ///< over the nodes, the contact and the landmarks: none below is larger
  std::optional<double> at_retractor_mm;   ///< mean over the nodes of the contact
  std::optional<double> landmarks_max_mm;  ///< largest over the landmarks inside the body, where there are any
  std::string why;

  static constexpr double limit_mm = 0.2;  ///< what is trusted misses less, at the landmarks or, without any, anywhere
  bool trusted() const {
    return known && stability != mechanics::Stability::Unstable && landmarks_max_mm.value_or(max_mm) < limit_mm;
  }
};

/// Whether the result holds within the theory that its kinematics stand for. Linear: the gap is known and trusted;
/// where it is not known, as Result::linearTrusted says, unless the body is unstable. Others: as Result::linearTrusted
/// says.
bool kinematicsValid(const Result& result);

/// Whether linear theory would do for this scene. Of a linear result as Result::linearTrusted says; of one in other
/// kinematics the gap is known and trusted or, where it is not known, strain and rotation of the answer are within the
/// limits of linear theory.
bool linearValid(const Result& result);

/// How far a linear answer is from one in other kinematics, both of the same scene: what linear theory misses, measured
/// and not estimated by a correction.
LinearGap gapBetween(const Model& model, const Result& linear, const Result& large,
                     const std::vector<Eigen::Vector3d>& landmarks_mm);

/// By one corotational Newton correction (mechanics::linearGap) on the model's voxels, whatever mesh gave the linear
/// result, or on cells of twice the edge (again and again) where the voxels have more than largestDofs degrees of
/// freedom: the correction is as smooth as what it corrects, and costs an eighth. landmarks_mm: LPS. Costs the assembly
/// of one tangent and two iterative solves. Throws BadArgument where the result is not linear; Cancelled.
LinearGap linearGap(const Model& model, const Setup& setup, const Result& result,
                    const std::vector<Eigen::Vector3d>& landmarks_mm, const Progress& progress = {},
                    int largestDofs = 60000);

/// Puts a gap into a linear result; what is wrong with it joins the result's doubts, and an unstable body takes away
/// Result::linearTrusted.
void putGap(const Setup& setup, LinearGap gap, Result& result);

/// Puts the gap into a converged linear result; what is wrong with it joins the result's validity, and an unstable body
/// takes away Result::linearTrusted. Does nothing for other results, nor where the result has its gap already. Throws
/// Cancelled.
void judgeByGap(const Model& model, const Setup& setup, const std::vector<Eigen::Vector3d>& landmarks_mm,
                Result& result, const Progress& progress = {});

}  // namespace glisson::retraction
