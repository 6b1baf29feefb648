// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/outline_proposal.h"

#include "image/io.h"
#include "pipeline/sources.h"
#include "roi/contour_io.h"
#include "roi/polygon.h"

namespace glisson::pipeline {

OutlineProposal proposeOutline(const std::filesystem::path& image, const Seed& seed,
                               const roi::ProposalOptions& options, const Progress& progress) {
  const AnatomicalImage in = loadImage(image, progress.part(0.0, 0.3));
  OutlineProposal p;
  p.seed_lps_mm = seed.isIndex ? in.volume.grid.indexToLps(seed.place) : seed.place;
  p.frameOfReferenceUid = in.frameOfReferenceUid;
  p.proposal = roi::propose(in.volume, p.seed_lps_mm, options, progress.part(0.3, 1.0));
  Diagnostics own;
  own.add(DiagnosticCode::ProposalOnly);
  if (p.proposal.touchesBorder) own.add(DiagnosticCode::ProposalAtBorder);
  p.diagnostics = in.diagnostics;
  p.diagnostics.add(own);
  p.warnings = in.warnings;
  for (const std::vector<std::string>& more : {p.proposal.notes, own.texts()})
    p.warnings.insert(p.warnings.end(), more.begin(), more.end());
  return p;
}

roi::ContourStack contoursOf(const OutlineProposal& proposal) {
  const image::Mask& mask = proposal.proposal.mask;
  roi::ContourStack contours = roi::contoursOf(mask);
  contours.frameOfReferenceUid = proposal.frameOfReferenceUid;
  for (roi::Polygon& polygon : contours.polygons)
    polygon = roi::simplified(polygon, 0.5 * mask.grid.spacing_mm.head<2>().minCoeff());
  return contours;
}

std::size_t writeProposal(const std::filesystem::path& file, const OutlineProposal& proposal) {
  if (image::isVolumeFile(file)) {
    image::writeVolume(file, proposal.proposal.mask);
    return 0;
  }
  const roi::ContourStack contours = contoursOf(proposal);
  roi::writeContours(file, contours);
  return contours.polygons.size();
}

}  // namespace glisson::pipeline
