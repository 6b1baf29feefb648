// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glisson::cohort {

/// One patient's folder. The number is its place among all folders by name, so that it is the same for every shard.
struct PatientFolder {
  int number = 1;
  std::string id;  ///< "case-001"; never the folder's name
  std::filesystem::path folder;
};

/// The folders directly below `cohort` that hold at least one file, by name; hidden ones and links are left out.
/// Throws BadInput where there is none.
std::vector<PatientFolder> findPatients(const std::filesystem::path& cohort);

/// SHA-256 over every file of a folder and its name below the folder, in the order of the names.
std::string digestOfFolder(const std::filesystem::path& folder);

/// The files that a patient's scene names: image, elastogram and region of interest.
struct PatientFiles {
  std::filesystem::path mri, mre, roi;
  std::vector<std::string> meaning = {};  ///< what the scene says of them, as further words of `measure`
};
/// From the patient's scene.json where it has one (a stiffness map stands for the elastogram where it names none), else
/// the folder itself for image and elastogram (series are found by role) and, for the region, the first of: roi.json,
/// contours.json; an RT Structure Set or Segmentation; a NIfTI, NRRD or MetaImage mask named *roi*, *mask*, *liver* or
/// *seg*. Throws BadInput where no region is found.
PatientFiles findFiles(const std::filesystem::path& folder);

/// The retraction of a patient as scene JSON with absolute paths, outputs empty, compared with the atlas.
/// sceneTemplate: text of a scene whose geometry is replaced. Throws BadInput.
std::string sceneOf(const std::filesystem::path& folder, const std::optional<std::string>& sceneTemplate);

/// The scene without its paths: what may stand in a result, and what the key of a result is made of.
std::string withoutPaths(const std::string& sceneJson);

}  // namespace glisson::cohort
