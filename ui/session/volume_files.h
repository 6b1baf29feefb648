// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "dicom/series.h"
#include "dicom/thumbnail.h"
#include "image/volume.h"

namespace glisson::session {

/// What a volume file (NIfTI, NRRD, MetaImage) looks like, by its name and its values.
enum class VolumeLook {
  Image,      ///< anything else
  Stiffness,  ///< its name speaks of stiffness
  Mask        ///< at most 16 different values, all whole numbers of 0 or more, 0 among them
};

/// name: of the file, without its folder.
VolumeLook lookOf(const std::string& name, const image::ScalarVolume& volume);

/// Whether a series is a volume file and not DICOM: it names no patient, day, frame of reference or unit. Its uid is
/// "file:" and the file's name, its number is counted from 1 among the volume files of the scan.
bool isVolume(const dicom::Series& series);

/// Makes series of the volume files among what the scan left out, and of none whose voxels cannot be read: these stay
/// left out, with the reason. Beside DICOM series they are for whoever gives them a role; alone, an image is the
/// anatomical one, a map of stiffness the elastogram, and a mask the anatomical one where there is nothing else.
void addVolumes(dicom::ScanResult& scan, const Progress& progress = {});

/// The series of a folder, file or archive, volume files included. only: names below the folder (relative paths), and
/// nothing else is looked at; empty: all. Throws BadInput as dicom::scan does.
dicom::ScanResult scanAll(const std::filesystem::path& path, const std::vector<std::string>& only,
                          const Progress& progress = {});

/// The folder that holds all these files and folders, and their names from there. One path: itself, and no names.
/// paths: absolute, at least one.
std::pair<std::filesystem::path, std::vector<std::string>> commonFolder(
    const std::vector<std::filesystem::path>& paths);

/// Roles of DICOM series alone: what a scene names, since a volume file is named by its path.
dicom::RoleOverrides dicomRoles(const dicom::RoleOverrides& roles);

/// Values of a series, whatever it is. Throws BadInput as dicom::readSeries and pipeline::loadImage do.
image::ScalarVolume readImage(const dicom::Series& series, const Progress& progress = {});

/// The middle slice of a series, whatever it is, as dicom::thumbnail has it.
dicom::Thumbnail smallPicture(const dicom::Series& series, int size_px);

}  // namespace glisson::session
