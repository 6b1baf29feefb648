// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Writing data sets with DCMTK; for .cpp files of this room only, after DCMTK's own headers.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "dicom/series.h"

namespace glisson::dicom {

/// A coded concept: code value, coding scheme, meaning.
struct Code {
  const char* value;
  const char* scheme;
  const char* meaning;
};

namespace codes {
inline constexpr Code liver{"10200004", "SCT", "Liver"};
inline constexpr Code organ{"123037004", "SCT", "Anatomical Structure"};
inline constexpr Code kilopascal{"kPa", "UCUM", "kilopascal"};
inline constexpr Code elasticity{"110830", "DCM", "Elasticity"};
inline constexpr Code shearModulus{"shear-modulus", "99GLISSON", "Shear modulus (mu)"};
inline constexpr Code youngsModulus{"youngs-modulus", "99GLISSON", "Young's modulus (E)"};
}  // namespace codes

/// Inserts into an item and turns any refusal of DCMTK into our fault: the values are made here.
class Writer {
 public:
  explicit Writer(DcmItem& item) : item_(item) {}

  void text(const DcmTagKey& tag, const std::string& value);
  void number(const DcmTagKey& tag, long value) { text(tag, std::to_string(value)); }
  /// DS of at most 16 characters each.
  void decimals(const DcmTagKey& tag, std::initializer_list<double> values);
  void word(const DcmTagKey& tag, int value);
  void longWord(const DcmTagKey& tag, std::uint32_t value);
  void longWords(const DcmTagKey& tag, const std::vector<std::uint32_t>& values);
  void real(const DcmTagKey& tag, double value);  ///< FD
  void attributeTag(const DcmTagKey& tag, const DcmTagKey& value);
  void code(const DcmTagKey& sequence, const Code& code);
  DcmItem& newItem(const DcmTagKey& sequence);
  /// A sequence with one item, made by fill.
  void group(const DcmTagKey& sequence, const std::function<void(Writer&)>& fill);
  /// As in source, or empty where source lacks it (Type 2).
  void copy(const DcmTagKey& tag, DcmItem& source);
  DcmItem& item() { return item_; }

  static void check(const OFCondition& status, const DcmTagKey& tag);

 private:
  DcmItem& item_;
};

/// What a derived object shares with the images that it was made from, and what is its own.
struct DerivedHeader {
  const char* sopClassUid;
  const char* modality;
  std::string seriesDescription;  ///< begins "RESEARCH"
  int seriesNumber;
  std::string identity;  ///< text that the new series and instance UIDs are made of
  bool sameFrame = true;
};

/// Parses the header of the first image of a series. Throws BadInput.
void readSourceHeader(const Series& source, DcmDataset& image);

/// Patient, study, frame of reference as in image; a series and an equipment of its own. Content date and time are
/// those of the study, so that the same input gives the same bytes.
void writeDerivedHeader(DcmDataset& data, DcmDataset& image, const Series& source, const DerivedHeader& header);

/// The frame of reference of a series, or one made of its UID where it states none.
std::string frameOfReference(const Series& source);

/// SeriesInstanceUID without the suffix that tells the volumes of one series apart.
std::string seriesInstanceUid(const Series& source);

/// Throws BadArgument or BadInput where a series cannot be referred to: no files, no SOP instance UIDs, not one image
/// per slice.
void checkReferable(const Series& source, const char* what);

/// SOP class and instance (and frame) of a slice.
void referToSlice(DcmItem& item, const Series& source, std::size_t slice);

/// ReferencedSeriesSequence with every image of the series.
void referToSeries(DcmDataset& data, const Series& source);

/// Multi-frame parts: dimension organisation by the given pointers, pixel measures and orientation shared.
void writeDimensions(Writer& root, const std::string& uid,
                     const std::vector<std::pair<DcmTagKey, DcmTagKey>>& pointerAndGroup);
void writeSharedGeometry(Writer& shared, const image::Grid& grid);
void writePlanePosition(Writer& frame, const image::Grid& grid, int k);
/// DerivationImageSequence that names the source slice.
void writeDerivation(Writer& frame, const Series& source, std::size_t slice, const Code& derivation,
                     const Code& purpose);

/// Coding scheme 99GLISSON explained.
void writeCodingSchemes(DcmDataset& data);

/// Saves beside, synchronised, then renamed. Throws BadInput where the folder cannot be written to.
void saveDicom(DcmFileFormat& format, const std::filesystem::path& file, E_TransferSyntax syntax);

}  // namespace glisson::dicom
