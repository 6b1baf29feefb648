// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::roi {

/// How a first contour is proposed from one point inside the organ.
struct ProposalOptions {
  double seedRadius_mm = 8.0;  ///< around the seed: tells what the organ looks like
  double spread = 3.0;         ///< intensities accepted: local mean of the organ ± spread × robust SD of its texture
  double neck_mm = 6.0;        ///< bridges thinner than twice this are cut (opening); larger cuts more
  double closing_mm = 4.0;     ///< gaps and vessels narrower than twice this are closed
  double smoothing_mm = 1.5;   ///< edge-preserving smoothing before all else (median in a ball); 0: none
  double edge_mm = 4.0;        ///< of the cells that are worked on (means of blocks of voxels)
  double least_mL = 150.0;     ///< of an organ: what is smaller is refused
  double most_mL = 4000.0;     ///< of an organ: what is larger has leaked and is refused
};

/// A proposed outline, to be corrected.
struct Proposal {
  image::Mask mask;              ///< on the image's grid
  double low = 0.0, high = 0.0;  ///< intensities accepted at the seed
  double volume_mL = 0.0;
  bool touchesBorder = false;      ///< of the image: cut off there, or leaked
  std::vector<std::string> notes;  ///< what was corrected: a sentence each
};

/// Grows from seed_lps over cells whose intensity is that of the organ nearby: the mean over the grown part in a
/// Gaussian of 20 mm, so that the shading of coils does not matter. Cuts thin bridges to neighbouring organs, keeps the
/// part with the seed, closes vessels, gaps and cavities. A seed in a vessel is moved to the tissue around it, and that
/// is said. A proposal to correct by hand, never a result.
/// Throws BadInput: seed outside the image or in air, in something thinner or smaller than an organ, or what grows is
/// larger than an organ can be.
Proposal propose(const image::ScalarVolume& image, const Eigen::Vector3d& seed_lps, const ProposalOptions& options = {},
                 const Progress& progress = {});

}  // namespace glisson::roi
