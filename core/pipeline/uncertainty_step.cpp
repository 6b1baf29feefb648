// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/uncertainty_step.h"

#include <algorithm>
#include <cmath>

#include "elastography/fill.h"

namespace glisson::pipeline::detail {
namespace {

/// The measured modulus on the model's cells; nothing where it is not measured.
std::optional<uncertainty::Elastogram> elastogramOf(const Scene& scene, const Inputs& inputs,
                                                    const image::Mask& cells) {
  const bool mre = scene.material.kind == MaterialSpec::Kind::Mre;
  if (!inputs.stiffness || (!mre && scene.material.kind != MaterialSpec::Kind::Map)) return {};
  const image::Mask* roi = mre && inputs.roiOnMre ? &inputs.roiOnMre->mask : nullptr;
  const uncertainty::Spreads& spreads = scene.uncertainty->spreads;
  const uncertainty::MapScatter scatter = uncertainty::scatterOf(*inputs.stiffness, roi, spreads.correlation_mm);
  uncertainty::Elastogram e;
  e.noise = spreads.noise >= 0 ? spreads.noise : scatter.noise;
  e.liver = scatter.liver;
  e.origin = mre ? elastography::fillStiffness(*inputs.stiffness, cells, roi).origin : cells;
  return e;
}

/// What the cells and, of linear answers, the kinematics may be off by, as other steps have estimated it.
std::vector<uncertainty::FurtherErrors> furtherErrorsOf(const RunResult& r) {
  std::vector<uncertainty::FurtherErrors> all;
  if (r.discretisation && r.discretisation->known) {
    uncertainty::FurtherErrors& cells = all.emplace_back();
    cells.kind = uncertainty::SourceKind::Cells;
    cells.place_mm = r.discretisation->mean_mm;
    if (const auto& d = r.discretisation->difference) {
      cells.difference_mm = cells.mean_mm = d->mean_mm;
      cells.at_retractor_mm = d->at_retractor_mm.value_or(0.0);
    }
  }
  if (r.primary.kinematics != retraction::Kinematics::Linear || !r.primary.linearGap || !r.primary.linearGap->known)
    return all;
  // Both answers are linear, and both gaps count.
  uncertainty::FurtherErrors& linear = all.emplace_back();
  linear.kind = uncertainty::SourceKind::Kinematics;
  linear.place_mm = r.primary.linearGap->mean_mm;
  const retraction::LinearGap none;
  const retraction::LinearGap &own = *r.primary.linearGap,
                              &other = r.atlas && r.atlas->linearGap ? *r.atlas->linearGap : none;
  linear.difference_mm = linear.mean_mm = std::hypot(own.mean_mm, other.mean_mm);
  linear.at_retractor_mm = std::hypot(own.at_retractor_mm.value_or(0.0), other.at_retractor_mm.value_or(0.0));
  return all;
}

/// Landmarks where branches end that no other leaves.
std::vector<std::size_t> tipsOf(const anatomy::VesselModel& vessels) {
  const std::vector<anatomy::VesselBranch>& branches = vessels.tree.branches;
  std::vector<bool> left(branches.size(), false);
  for (const anatomy::VesselBranch& b : branches)
    if (b.parent >= 0) left[static_cast<std::size_t>(b.parent)] = true;
  std::vector<std::size_t> tips;
  const std::vector<Eigen::Vector3d>& line = vessels.centreline_lps_mm;
  for (std::size_t b = 0; b < branches.size(); ++b) {
    if (left[b] || branches[b].points_lps_mm.empty()) continue;
    const auto end = std::find(line.begin(), line.end(), branches[b].points_lps_mm.back());
    if (end != line.end()) tips.push_back(static_cast<std::size_t>(end - line.begin()));
  }
  return tips;
}

bool shearKnown(const Scene& scene, const Inputs& inputs) {
  switch (scene.material.kind) {
    case MaterialSpec::Kind::Uniform: return scene.material.quantity == StiffnessQuantity::Shear;
    case MaterialSpec::Kind::Map:
    case MaterialSpec::Kind::Mre: return inputs.stiffness && inputs.stiffness->quantity == StiffnessQuantity::Shear;
    case MaterialSpec::Kind::Atlas: break;
  }
  return true;
}

}  // namespace

uncertainty::Uncertainty uncertaintyOf(const Scene& scene, const Inputs& inputs, const image::Mask& cells,
                                       const retraction::Setup& setup, const anatomy::VesselModel& vessels,
                                       const retraction::Model* atlas, const RunResult& r, const Progress& progress) {
  std::optional<uncertainty::Retracted> textbook;
  if (atlas != nullptr && r.atlas)
    textbook.emplace(uncertainty::Retracted{*atlas, *r.atlas, scene.compare->quantity == StiffnessQuantity::Shear});
  const uncertainty::Case patient{{r.model, r.primary, shearKnown(scene, inputs)},
                                  textbook,
                                  setup,
                                  r.landmarks_mm,
                                  elastogramOf(scene, inputs, cells),
                                  furtherErrorsOf(r),
                                  tipsOf(vessels)};
  return uncertainty::propagate(patient, *scene.uncertainty, scene.setup.seed, progress);
}

}  // namespace glisson::pipeline::detail
