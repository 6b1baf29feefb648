#pragma once

#include "base/progress.h"
#include "image/volume.h"

namespace glisson::roi {

/// How a first contour is proposed from one point inside the organ.
struct ProposalOptions {
  double seedRadius_mm = 8.0;  ///< around the seed: tells what the organ looks like
  double spread = 3.0;         ///< intensities accepted: median ± spread × robust SD of the surroundings
  double neck_mm = 6.0;        ///< bridges thinner than twice this are cut (opening); larger cuts more
  double closing_mm = 4.0;     ///< gaps and vessels narrower than twice this are closed
  double smoothing_mm = 1.5;   ///< edge-preserving smoothing before all else (median in a ball); 0: none
};

struct Proposal {
  image::Mask mask;              ///< on the image's grid
  double low = 0.0, high = 0.0;  ///< intensities accepted
  double volume_mL = 0.0;
  bool touchesBorder = false;  ///< of the image: cut off there, or leaked
};

/// Grows from seed_lps over voxels of similar intensity, cuts thin bridges to neighbouring organs, keeps the part with
/// the seed, closes gaps and cavities. A proposal to correct by hand, never a result.
/// Throws BadInput: seed outside the image, or what grows from it is smaller than its surroundings (not in an organ).
Proposal propose(const image::ScalarVolume& image, const Eigen::Vector3d& seed_lps, const ProposalOptions& options = {},
                 const Progress& progress = {});

}  // namespace glisson::roi
