// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// DCMTK seen through a few strict functions; for .cpp files of this room only.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dicom/file_layout.h"
#include "dicom/origin.h"

class DcmDataset;
class DcmItem;
class DcmTagKey;

namespace glisson::dicom {

/// Parses the bytes of the header (up to the pixel element), which never holds the pixels. DCMTK's own log is off: it
/// may quote values of the patient. Throws BadInput where DCMTK refuses them.
void parseHeader(const ByteSource& source, const FileLayout& layout, DcmDataset& dataset);

/// Text of an attribute without padding; all values where it has several, parted by backslashes. Empty where absent.
/// Attributes that a file keeps as raw bytes (unknown private ones) are read too.
std::string text(DcmItem& item, const DcmTagKey& tag);

/// As text(), as UTF-8 without control characters, at most 64 bytes.
std::string shownText(DcmItem& item, const DcmTagKey& tag);

/// As text(), turned into UTF-8 by the character set that the object names; as it is where that cannot be done. For
/// comparing what two objects say, which may be written in different character sets.
std::string unifiedText(DcmItem& item, const DcmTagKey& tag);

/// UTF-8 without control characters (bytes that are no UTF-8 are taken as Latin-1), at most 64 bytes.
std::string cleaned(const std::string& raw);

/// As text(), of a private attribute: in the block that its creator reserved in this file, which may be any. Where no
/// creator says whose the first block is (some software leaves it out), that one. Empty where there is none.
std::string privateText(DcmItem& item, std::uint16_t group, std::uint8_t element, const char* creator);

/// The numbers of a decimal string, an integer string or a binary attribute; empty where absent. Throws BadInput,
/// naming the attribute and the value, where one is no finite number.
std::vector<double> numbers(DcmItem& item, const DcmTagKey& tag);

/// The one number of an attribute. Throws BadInput where there are several, or one that is not finite.
std::optional<double> number(DcmItem& item, const DcmTagKey& tag);

/// The unsigned value of a US attribute; nothing where absent.
std::optional<int> count(DcmItem& item, const DcmTagKey& tag);

/// Item index of a sequence, or null.
DcmItem* itemOf(DcmItem& item, const DcmTagKey& sequence, unsigned long index = 0);

/// Number of items of a sequence; 0 where absent.
unsigned long itemCount(DcmItem& item, const DcmTagKey& sequence);

/// Patient and study of an object. The key is empty where neither PatientID nor PatientName says who it is; trailing
/// empty parts of a name make no other patient.
Origin originOf(DcmItem& item);

/// "Name (gggg,eeee)" for messages.
std::string nameOf(const DcmTagKey& tag);

}  // namespace glisson::dicom
