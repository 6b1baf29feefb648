// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "dicom/acquisitions.h"
#include "dicom/origin.h"
#include "dicom/series.h"
#include "elastography/roi_mapping.h"
#include "elastography/statistics.h"
#include "elastography/stiffness_map.h"
#include "image/volume.h"
#include "pipeline/outlined.h"
#include "roi/contour_stack.h"

namespace glisson::pipeline {

/// An image with what is known of its place in the patient.
struct AnatomicalImage {
  image::ScalarVolume volume;
  std::string frameOfReferenceUid;  ///< empty for files without one
  std::string patientKey;           ///< to tell patients apart, never to show
  std::string studyDate;            ///< to compare, never to show
  std::string studyUid;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
  std::vector<std::string> rolesNotFound;         ///< series named in roles that are not here
  std::shared_ptr<const dicom::ScanResult> scan;  ///< of DICOM images
  int series = -1;                                ///< taken, in scan
};

/// A DICOM folder, file, DICOMDIR or ZIP archive (the series that was outlined, else its anatomical series; where there
/// is none, its only series) or a NIfTI/NRRD/MHA volume. roles: set by hand.
AnatomicalImage loadImage(const std::filesystem::path& path, const Progress& progress = {},
                          const dicom::RoleOverrides& roles = {}, const OutlineNames& outlined = {});

/// How a bare map is to be understood; a DICOM series knows by itself.
struct MapMeaning {
  std::optional<StiffnessQuantity> quantity;
  std::optional<std::string> unit;
  dicom::RoleOverrides roles{};             ///< set by hand
  OutlineNames outlined{};                  ///< what the region of interest was drawn on
  std::optional<double> confidenceScale{};  ///< stored value of full confidence; empty: by the map
  bool mayBeUneven = false;  ///< for statistics alone: slices may lie unevenly (StiffnessMap::unevenSlices_mm)
};

/// A stiffness map as read, with where it comes from.
struct LoadedStiffness {
  elastography::StiffnessMap map;
  std::string patientKey;
  std::string studyDate;
  std::string studyUid;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
  std::vector<std::string> rolesNotFound;         ///< as in AnatomicalImage
  std::shared_ptr<const dicom::ScanResult> scan;  ///< of DICOM images
  dicom::Acquisition acquisition;                 ///< what was taken, in scan
};

/// The map of a stiffness series in kPa: in the unit and of the quantity that are asked for, else that its code, its
/// unit or its words name, else of the shear modulus. A wave speed becomes the shear modulus. What holds no value is
/// not-a-number. Throws BadInput where the unit is not known, or the series says that it holds something else.
elastography::StiffnessMap readStiffness(const dicom::Series& series, const MapMeaning& meaning, Diagnostics& said,
                                         const Progress& progress = {});

/// Attaches a confidence series to the map. scale: stored value of full confidence, empty where the map says it.
void readConfidence(const dicom::Series& series, std::optional<double> scale, elastography::StiffnessMap& map,
                    Diagnostics& said, const Progress& progress = {});

/// A DICOM folder (its stiffness series, and the confidence series of the same acquisition where it has one) or a bare
/// map, for which quantity and unit must be given. Throws BadInput, asking for them where they are missing.
LoadedStiffness loadStiffness(const std::filesystem::path& path, const MapMeaning& meaning,
                              const Progress& progress = {});

/// Something in which two things that would be used together differ.
struct Difference {
  enum class In { Patient, Day, Frame } in;  ///< another frame of reference is told, the others are refused
  std::string what;                          ///< in words, without a full stop
};

/// In what an MRI and an elastogram differ that may not be passed over. What either does not say is not compared.
std::vector<Difference> differences(const AnatomicalImage& mri, const LoadedStiffness& mre);

/// Whether an MRI and an elastogram may be used together. Throws BadInput where they are of different patients or study
/// dates, unless overridden; returns what to tell and to store: that, and different frames of reference (the patient
/// may have moved), each with whether it was overridden. What either does not say is not compared.
std::vector<std::string> checkTogether(const AnatomicalImage& mri, const LoadedStiffness& mre, bool overridden);

/// Throws BadInput where a series that a role was given for is in none of the inputs (each with its rolesNotFound).
void checkRolesFound(const dicom::RoleOverrides& roles, const std::vector<std::vector<std::string>>& notFound);

/// A region of interest as it came: polygons (contour JSON, RT Structure Set) or voxels (NIfTI, NRRD, MHA,
/// DICOM Segmentation).
struct LoadedRoi {
  std::optional<roi::ContourStack> contours;
  std::optional<image::Mask> mask;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
  OutlineNames names;               ///< what it says that it was drawn on
  bool ofDicom = false;             ///< a structure set or a segmentation
  std::string frameOfReferenceUid;  ///< of DICOM objects and contour files that name one; else empty
  dicom::Origin origin;             ///< of DICOM objects; else empty
  std::string referencedSeriesUid;  ///< the series that the Segmentation was made on; empty where it names none
};

/// name: structure or segment to take; empty = found by its name. label: of a label map (0 = any), or number of a
/// segment or structure. A folder must hold one region of interest; copies count once.
LoadedRoi loadRoi(const std::filesystem::path& path, const std::string& name, int label, const Progress& progress = {});

/// In what a region of interest differs from the images that it is used with (null: not used).
std::vector<Difference> differences(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre);

/// Whether a region of interest belongs to the images that it is used with (null: not used). Throws BadInput where it
/// is of another patient; or of another examination day, unless a frame of reference that it shares with an image puts
/// it in place; each unless overridden. Returns what to tell and to store: that, and a frame of reference that the MRI
/// does not have (mapRoi compares the elastogram's). What either does not say is not compared.
std::vector<std::string> checkRoi(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre,
                                  bool overridden);

/// What is doubtful about the images that a region of interest was drawn on (null: not used): contours that are not on
/// the image that they name, a series that is not here, no frame of reference.
Diagnostics doubtsAboutOutline(const LoadedRoi& roi, const AnatomicalImage* mri, const LoadedStiffness* mre);

/// Whether regions of several readers may be compared: the same rules, each with the first; overridden as above.
std::vector<std::string> checkReaders(const std::vector<LoadedRoi>& rois, bool overridden);

/// Adds to the region's diagnostics and warnings what is doubtful about its outlines on the image that they were drawn
/// on (roi::outlineDoubts); nothing where it came as voxels.
void checkOutlines(LoadedRoi& roi, const image::Grid& mriGrid);

/// Fills empty slices between outlined ones by shape, where the region came as polygons (roi/interpolate.h). Returns
/// what to tell the user, empty where every slice between the first and the last outlined one holds an outline that was
/// drawn, and none is a draft.
std::optional<std::string> completeOutlines(LoadedRoi& roi, const image::Grid& mriGrid);

/// The region of interest on the grid of the elastogram. mriGrid: of the image that polygons were drawn on, where
/// known: then outlines are completed first, so that an MRE slice on an undrawn MRI slice gets the interpolated region.
elastography::MappedRoi mapRoi(const LoadedRoi& roi, const std::optional<image::Grid>& mriGrid,
                               const elastography::StiffnessMap& map);

}  // namespace glisson::pipeline
