// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "dicom/series.h"

namespace glisson::dicom {

/// The secret of one project, from which new identifiers, pseudonyms and date shifts follow: same key, same results.
/// Who has it can tell which new identifier belongs to which old one; it is kept apart from the results.
struct ProjectKey {
  std::string secret;  ///< 64 hexadecimal digits
};

/// Reads a key file, or makes one (mode 0600, from the system's random source) where there is none. Throws BadInput
/// where the file is no key file, or lies inside one of the given folders.
ProjectKey openProjectKey(const std::filesystem::path& file, const std::vector<std::filesystem::path>& keepOutOf);

/// HMAC-SHA-256 of text with the key, 64 hexadecimal digits.
std::string keyedDigest(const ProjectKey& key, const std::string& text);

/// Options of the Basic Application Confidentiality Profile [PS3.15 annex E].
struct DeidentifyOptions {
  bool shiftDates = false;           ///< retain longitudinal temporal information with modified dates
  bool cleanDescriptors = false;     ///< keep of descriptions the words that say how an image was made
  bool keepCharacteristics = false;  ///< retain age (90 at most), sex, size and weight
};

/// How many attributes of all files were changed, those inside sequences too.
struct AttributeChanges {
  std::size_t removed = 0;         ///< standard attributes, with what they held
  std::size_t privateRemoved = 0;  ///< attributes of a maker
  std::size_t emptied = 0;         ///< that held something
  std::size_t replaced = 0;        ///< names, IDs and texts by a pseudonym or a word of ours
  std::size_t uids = 0;            ///< mapped by the key
  std::size_t dates = 0;           ///< emptied or shifted
  std::size_t codes = 0;           ///< of schemes that are not known
};

/// What a de-identification has written and left out.
struct DeidentifyResult {
  std::vector<std::filesystem::path> files;  ///< written, below the output folder
  std::vector<SkippedFile> leftOut;          ///< no DICOM, or pixels that may show who the patient is; with the reason
  std::vector<std::string> notes;            ///< what was done, in words
  AttributeChanges changes;                  ///< of the files that were written
  std::size_t patients = 0;                  ///< of these files, by pseudonym
};

/// Copies every DICOM object below `in` to `out` without what identifies the patient: the actions of the basic profile
/// for named attributes (deidentify_actions.cpp), and beyond it every private attribute but a stated safe list, every
/// person name, date, time and free text that is not on a list of technical attributes, overlays, curves and icons.
/// UIDs are mapped by the key, consistently over files and runs. Series roles are decided first, on the originals, and
/// kept in words of our own in SeriesDescription. File and folder names are made of new identifiers. Objects whose
/// pixels may show who the patient is (BurnedInAnnotation YES, secondary captures and colour without NO, encapsulated
/// documents) are left out. Pixels are copied bit for bit. Throws BadInput where in is missing or out is not empty.
DeidentifyResult deidentify(const std::filesystem::path& in, const std::filesystem::path& out, const ProjectKey& key,
                            const DeidentifyOptions& options, const Progress& progress = {});

}  // namespace glisson::dicom
