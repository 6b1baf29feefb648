// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cohort/cohort.h"

namespace glisson::cohort {

/// The numbers of one patient that the summary needs; NaN where there is none.
struct CaseRecord {
  CaseOutcome outcome;
  std::string key;          ///< SHA-256 of the patient's files, the scene without its paths, and the version
  double shear_kPa = 0.0;   ///< mean shear modulus over the region (confidence mask applied)
  double youngs_kPa = 0.0;  ///< mean Young's modulus, 3 µ
  double sd_kPa = 0.0;      ///< of the shear modulus
  long long voxels = 0;     ///< that the mean is over
  double mean_mm = 0.0, p95_mm = 0.0, max_mm = 0.0, at_retractor_mm = 0.0;  ///< MRE against atlas
  double vessel_mean_mm = 0.0, vessel_beyond_5mm = 0.0;
  double travel_mm = 0.0, atlas_travel_mm = 0.0;  ///< of a rigid bar, with either stiffness
  double travel_difference_mm = 0.0;              ///< measured less atlas
  double pose_height_mm = 0.0;                    ///< of the bar above the lowest point of the right lobe
  double discretisation_mm = 0.0;                 ///< of a displacement, at its worst cell
  double difference_error_mm = 0.0;               ///< discretisation error of at_retractor_mm
  /// Of a run that says how sure it is: 95 % interval of at_retractor_mm; probabilities that it is 5 mm or more, that
  /// the travel differs by as much, and that mean_mm is at most one voxel of the MRI.
  double at_retractor_low_mm = 0.0, at_retractor_high_mm = 0.0;
  double probability_beyond_5mm = 0.0, probability_travel_beyond_5mm = 0.0, probability_within_voxel = 0.0;
  double volume_mL = 0.0, p95_strain = 0.0, rotation_deg = 0.0;
  long long dofs = 0;
  bool linear_valid = false;
  bool kinematics_valid = false;  ///< the theory that was used holds
  std::string kinematics;         ///< that were used
  bool drawable = true;           ///< both predictions are deformations: converged, no cell inside out
  std::vector<std::string> warnings;
  bool measured() const;  ///< has a stiffness
};

/// From what `measure --json` and `run --json` print; run: empty where the retraction did not take place.
CaseRecord recordOf(const std::string& id, const std::string& key, const std::string& measureJson,
                    const std::string& runJson);

/// One result.json; numbers as shortest exact decimals, so that equal results are equal bytes.
std::string toJson(const CaseRecord& record);
/// Nothing where the text is not a whole record (an interrupted writer, another version).
std::optional<CaseRecord> parseRecord(const std::string& text);

/// Records below <output>/cases, by id.
std::vector<CaseRecord> readRecords(const std::filesystem::path& output);

/// Written beside and renamed; flushed to the disk before.
void writeWhole(const std::filesystem::path& file, const std::string& text);
std::string readWhole(const std::filesystem::path& file);

}  // namespace glisson::cohort
