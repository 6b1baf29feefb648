// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dicom/origin.h"
#include "dicom/series.h"
#include "image/volume.h"

namespace glisson::dicom {

/// One segment of a Segmentation object.
struct Segment {
  int number = 1;  ///< SegmentNumber, from 1
  std::string label;
  std::string propertyCode;  ///< "scheme:value" of the segmented property type, e.g. "SCT:10200004"; reading only
  image::Mask mask;          ///< on the grid shared by all segments of the object
};

/// Where a frame lies and which image it says that it was drawn on. A frame of a label map stands here once for each of
/// the segments that it holds.
struct SegmentFrame {
  int segment = 0;
  Eigen::Vector3d position_lps_mm = Eigen::Vector3d::Zero();  ///< of its first pixel
  std::string sourceSopInstanceUid;
};

/// A Segmentation as read. Segments may overlap: each has a mask of its own.
struct SegmentationSet {
  Origin origin;
  std::string frameOfReferenceUid;
  std::string referencedSeriesUid;                     ///< empty where the object names none
  std::vector<std::string> referencedSopInstanceUids;  ///< of the images that the frames were drawn on
  std::vector<Segment> segments;                       ///< ascending by number
  std::vector<SegmentFrame> frames;                    ///< those that name a source image
  std::vector<std::string> warnings;
};

/// Reads BINARY, FRACTIONAL (a fractional voxel is inside from half the maximum on) and LABELMAP segmentations; native,
/// RLE and deflated frames (16-bit labels: native ones). The grid spans all frames; slices between them that no frame
/// covers are empty. A plain file is parsed here, all others in a process of their own with limits, as images are.
/// Throws BadInput: no Segmentation, frames that do not lie on one regular grid, a frame of an unknown segment, a
/// transfer syntax that is not decoded (named), truncated pixels, more voxels than fit the memory budget.
SegmentationSet readSegmentation(const std::filesystem::path& file);

/// Whether the file's header says that it is a Segmentation; false for anything unreadable.
bool isSegmentation(const std::filesystem::path& file);

/// Masks of one segment or of all (number 0) as one mask. Throws BadInput listing the segments where there is no such
/// one, or where nothing is inside.
image::Mask maskOf(const SegmentationSet& set, int number);

/// What other objects need to refer to a written segmentation.
struct WrittenSegmentation {
  std::string sopInstanceUid, seriesInstanceUid;
  std::vector<std::vector<int>> frameOfSlice;  ///< [segment][slice of source]: frame number from 1, 0 where empty
};

/// Writes a BINARY Segmentation of the source series: one frame for every slice of a segment that holds voxels, each
/// with its source image; liver as SCT 10200004. Masks must lie on the grid of source. Throws BadArgument where they do
/// not, BadInput where all are empty or the file cannot be written.
WrittenSegmentation writeSegmentation(const std::filesystem::path& file, const std::vector<Segment>& segments,
                                      const Series& source, std::uint64_t seed);

}  // namespace glisson::dicom
