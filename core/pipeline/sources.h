#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "dicom/series.h"
#include "elastography/roi_mapping.h"
#include "elastography/statistics.h"
#include "elastography/stiffness_map.h"
#include "image/volume.h"
#include "roi/contour_stack.h"

namespace glisson::pipeline {

/// An image with what is known of its place in the patient.
struct AnatomicalImage {
  image::ScalarVolume volume;
  std::string frameOfReferenceUid;  ///< empty for files without one
  std::string patientKey;           ///< to tell patients apart, never to show
  std::vector<std::string> warnings;
};

/// A DICOM folder or file (its anatomical series; where there is none, its only series) or a NIfTI/NRRD/MHA volume.
AnatomicalImage loadImage(const std::filesystem::path& path, const Progress& progress = {});

/// How a bare map is to be understood; a DICOM series knows by itself.
struct MapMeaning {
  std::optional<StiffnessQuantity> quantity;
  std::optional<std::string> unit;
};

struct LoadedStiffness {
  elastography::StiffnessMap map;
  std::string patientKey;
  std::vector<std::string> warnings;
};

/// A DICOM folder (its stiffness series, and its confidence series where it has one) or a bare map, for which quantity
/// and unit must be given. Throws BadInput, asking for them where they are missing.
LoadedStiffness loadStiffness(const std::filesystem::path& path, const MapMeaning& meaning,
                              const Progress& progress = {});

/// A region of interest as it came: polygons (contour JSON, RT Structure Set) or voxels (NIfTI, NRRD, MHA).
struct LoadedRoi {
  std::optional<roi::ContourStack> contours;
  std::optional<image::Mask> mask;
  std::vector<std::string> warnings;
};

/// name: structure to take; empty = found by its name. label: of a label map, 0 = any.
LoadedRoi loadRoi(const std::filesystem::path& path, const std::string& name, int label, const Progress& progress = {});

/// Fills empty slices between outlined ones by shape, where the region came as polygons (roi/interpolate.h). Returns
/// what to tell the user, empty where every slice between the first and the last outlined one holds an outline that was
/// drawn.
std::optional<std::string> completeOutlines(LoadedRoi& roi, const image::Grid& mriGrid);

/// The region of interest on the grid of the elastogram. mriGrid: of the image that polygons were drawn on, where
/// known: then outlines are completed first, so that an MRE slice on an undrawn MRI slice gets the interpolated region.
elastography::MappedRoi mapRoi(const LoadedRoi& roi, const std::optional<image::Grid>& mriGrid,
                               const elastography::StiffnessMap& map);

}  // namespace glisson::pipeline
