// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "image/volume.h"
#include "phantom/liver_shape.h"
#include "roi/contour_stack.h"

namespace glisson::phantom {

/// What to draw. The same options give the same bytes, on any number of threads.
struct PhantomOptions {
  int cases = 1;
  std::uint64_t seed = 1;
  bool paperCohort =
      false;       ///< stiffness by quota: 30 % above 3.1 kPa, among them 20 % above 4.2 kPa, rest near 2.1 kPa
  int number = 1;  ///< makePhantom: the patient's number, 1 … 9999, for its name and series ("PHANTOM^001")
  LiverShape shape = LiverShape::Usual;
  std::optional<double> shear_kPa;  ///< makePhantom: the mean shear modulus; drawn between 2 and 6 kPa where absent
};

/// One branch of a vein tree: a centre line of one radius, from its fork on the root's side to its next fork.
struct VesselBranch {
  std::string name;      ///< "portal" or "hepatic"
  int parent = -1;       ///< index of the branch it leaves, among all vessels; −1 at the root
  double radius_mm = 0;  ///< Murray's law: radius³ = Σ radius³ of the branches that leave
  std::vector<Eigen::Vector3d> points_lps_mm;
};

/// What is known exactly, because it was made so.
struct PhantomTruth {
  std::uint64_t seed = 0;
  LiverShape shape = LiverShape::Usual;
  double shear_kPa = 0;            ///< mean µ of the noise-free map over the liver's MRE voxels of adequate confidence
  double wholeLiverShear_kPa = 0;  ///< the same over all MRE voxels whose centre lies in the liver
  double noise_kPa = 0;            ///< standard deviation of the noise added per adequate voxel
  double volume_mL = 0;            ///< voxel centres of the MRI in the liver × voxel volume
  std::size_t confidentVoxels = 0;
  std::size_t liverVoxels = 0;  ///< on the MRE grid
  std::vector<VesselBranch> vessels;
};

/// Colours, 0 to 255.
using RgbVolume = image::Volume<std::array<std::uint8_t, 3>>;
/// Stored values of signed 16-bit images.
using Int16Volume = image::Volume<std::int16_t>;

/// A synthetic patient in memory. The MRE planes are every fourth MRI plane, in-plane grids are the same.
struct PhantomPatient {
  int number = 1;
  PhantomTruth truth;
  image::Mask liver;                   ///< on the MRI grid
  image::Mask liverMre;                ///< on the MRE grid
  image::ScalarVolume cleanShear_kPa;  ///< on the MRE grid, without noise; 0 outside the liver
  Int16Volume mri;                     ///< contrast-enhanced, arbitrary units
  Int16Volume magnitude;               ///< of the MRE acquisition, arbitrary units
  std::vector<Int16Volume> wave;  ///< at waveSteps equal parts of a period; radians = value · π / (waveWindowWidth / 2)
  Int16Volume stiffness_Pa;       ///< shear modulus with noise; nonsense where the confidence is low
  Int16Volume confidence;         ///< 0 … 999
  RgbVolume colour;               ///< the stiffness map in colours, 0–8 kPa
  roi::ContourStack contours;     ///< the liver as a hand would draw it, slice by slice; no UIDs yet
  static constexpr double waveWindowWidth = 6283.0;
  static constexpr int waveSteps = 4;
};

/// Makes one patient; options.number and options.shear_kPa apply, cases and paperCohort do not.
/// Throws BadArgument where shear_kPa is not in [0.5, 15] or number not in [1, 9999].
PhantomPatient makePhantom(std::uint64_t seed, const PhantomOptions& options = {}, const Progress& progress = {});

/// Writes mri/, mre/{magnitude, wave, stiffness, confidence, colour}/, rtstruct.dcm, scene.json and truth.json into the
/// folder (made where it is missing). Throws BadInput where it cannot be written to.
void writePhantom(const PhantomPatient& patient, const std::filesystem::path& folder);

/// One patient of a cohort, before it is made.
struct CaseDraw {
  std::uint64_t seed = 0;
  double shear_kPa = 0;
};

/// Seeds and mean shear moduli of a cohort. With paperCohort the quotas hold exactly: round(0.3 N) cases above 3.1 kPa,
/// round(0.2 N) of them above 4.2 kPa; who gets which is shuffled. Throws BadArgument where cases is not in [1, 9999].
std::vector<CaseDraw> drawCohort(const PhantomOptions& options);

/// Makes and writes patient-001, patient-002, ... below the folder; returns the patients' folders.
std::vector<std::filesystem::path> writeCohort(const PhantomOptions& options, const std::filesystem::path& folder,
                                               const Progress& progress = {});

}  // namespace glisson::phantom
