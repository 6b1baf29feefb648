// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/progress.h"
#include "elastography/registration.h"
#include "elastography/roi_mapping.h"
#include "elastography/statistics.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {

/// A region of interest on an elastogram, and how its stiffness is to be measured.
struct MeasureRequest {
  std::filesystem::path mre;                  ///< as loadStiffness takes it
  std::filesystem::path roi;                  ///< as loadRoi takes it
  std::filesystem::path mri;                  ///< image that the outlines were drawn on; may be empty
  std::optional<StiffnessQuantity> quantity;  ///< of a bare map
  std::optional<std::string> unit;            ///< of a bare map: "Pa", "kPa" or "<factor>kPa"
  dicom::RoleOverrides roles;                 ///< of series, set by hand
  bool overrideChecks = false;                ///< MRI, elastogram and region of other days or patients are meant
  std::optional<int> label;                   ///< of a mask, 0 = any; number of a structure or segment
  std::string name;                           ///< structure of an RT Structure Set; empty = found by its name
  std::optional<double> confidence;           ///< voxels below are left out, 0 to 1; empty: the default
  std::optional<double> confidenceScale;      ///< stored value that means full confidence; empty: told by the map
  int erosion_pixels = 0;                     ///< taken off the border, in each slice
  double erosion_mm = 0.0;                    ///< the same from the outline
  std::filesystem::path exclude;              ///< mask of what is left out; may be empty
  bool registration = false;                  ///< the magnitude images are laid over the MRI (another breath-hold)
  std::filesystem::path magnitude;            ///< these images, where they lie elsewhere; may be empty
  double poisson = 0.5;                       ///< for the conversion to the other modulus
};

/// What was measured, on what, and what is doubtful about it.
struct MeasuredRegion {
  elastography::Measurement measurement;
  LoadedStiffness mre;             ///< after the registration, where one was asked for
  elastography::MappedRoi region;  ///< on the elastogram
  std::optional<elastography::Registration> registration;
  std::vector<std::string> warnings;  ///< texts, those of diagnostics among them
  Diagnostics diagnostics;
};

/// Stiffness statistics of a region of interest from files. Throws BadInput where they cannot be read or do not belong
/// together, a map says neither quantity nor unit, a mask has several labels and none is chosen, no voxel is left, or a
/// registration or an exclusion is not offered for these images.
MeasuredRegion measureRegion(const MeasureRequest& request, const Progress& progress = {});

}  // namespace glisson::pipeline
