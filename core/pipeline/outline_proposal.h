// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "roi/contour_stack.h"
#include "roi/propose.h"

namespace glisson::pipeline {

/// Where a proposal begins.
struct Seed {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< LPS mm, or a voxel index
  bool isIndex = false;
};

/// A first outline of an organ on an image from files, with what is to be told of both.
struct OutlineProposal {
  roi::Proposal proposal;
  Eigen::Vector3d seed_lps_mm = Eigen::Vector3d::Zero();
  std::string frameOfReferenceUid;    ///< of the image; empty where it has none
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
};

/// image: as loadImage takes it. Throws BadInput as loadImage and roi::propose do.
OutlineProposal proposeOutline(const std::filesystem::path& image, const Seed& seed,
                               const roi::ProposalOptions& options = {}, const Progress& progress = {});

/// The proposal as polygons: the stairs of its voxels are taken off by half a pixel, its area stays.
roi::ContourStack contoursOf(const OutlineProposal& proposal);

/// Writes a mask where the file's extension is that of a volume, else contours. Returns the number of polygons, 0 for a
/// mask. Throws BadInput where it cannot be written.
std::size_t writeProposal(const std::filesystem::path& file, const OutlineProposal& proposal);

}  // namespace glisson::pipeline
