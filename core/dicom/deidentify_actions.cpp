// SPDX-License-Identifier: GPL-3.0-or-later

// The rows of PS3.15 table E.1-1 that occur in MR, Enhanced MR, RT Structure Set, Segmentation, Parametric Map, SR and
// Secondary Capture, and a rule for the rest: what is not listed here as technical and could hold words, names or dates
// is removed. So the table can be shorter than the standard's and removes more.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>

#include "dicom/detail/deidentify_actions.h"

namespace glisson::dicom {
namespace {

// Rows with an action of their own, ascending.
struct Row {
  std::uint32_t tag;
  Action action;
};
constexpr Row rows[] = {
    {0x00080014, Action::Uid},             // Instance Creator UID
    {0x00080018, Action::Uid},             // SOP Instance UID
    {0x00080020, Action::Date},            // Study Date, Z
    {0x00080021, Action::Date},            // Series Date
    {0x00080022, Action::Date},            // Acquisition Date
    {0x00080023, Action::Date},            // Content Date, Z/D
    {0x0008002A, Action::Date},            // Acquisition DateTime
    {0x00080030, Action::Empty},           // Study Time, Z
    {0x00080031, Action::Remove},          // Series Time
    {0x00080032, Action::Remove},          // Acquisition Time
    {0x00080033, Action::Dummy},           // Content Time, Z/D
    {0x00080050, Action::Empty},           // Accession Number, Z
    {0x00080070, Action::Keep},            // Manufacturer
    {0x00080080, Action::Remove},          // Institution Name
    {0x00080081, Action::Remove},          // Institution Address
    {0x00080082, Action::Remove},          // Institution Code Sequence
    {0x00080090, Action::Empty},           // Referring Physician's Name, Z
    {0x00080092, Action::Remove},          // Referring Physician's Address
    {0x00080094, Action::Remove},          // Referring Physician's Telephone
    {0x00080096, Action::Remove},          // Referring Physician Identification Sequence
    {0x00080201, Action::Remove},          // Timezone Offset From UTC
    {0x00081030, Action::Remove},          // Study Description
    {0x00081032, Action::Remove},          // Procedure Code Sequence
    {0x0008103E, Action::Remove},          // Series Description; replaced by the role
    {0x0008103F, Action::Remove},          // Series Description Code Sequence
    {0x00081070, Action::Empty},           // Operators' Name, X/Z/D: Type 2 in RT Structure Sets
    {0x00081080, Action::Remove},          // Admitting Diagnoses Description
    {0x00081084, Action::Remove},          // Admitting Diagnoses Code Sequence
    {0x00081090, Action::Keep},            // Manufacturer's Model Name
    {0x00081110, Action::Remove},          // Referenced Study Sequence
    {0x00081111, Action::Empty},           // Referenced Performed Procedure Step Sequence
    {0x00081120, Action::Remove},          // Referenced Patient Sequence
    {0x00081155, Action::Uid},             // Referenced SOP Instance UID
    {0x00081195, Action::Uid},             // Transaction UID
    {0x00082111, Action::Remove},          // Derivation Description
    {0x00083010, Action::Uid},             // Irradiation Event UID
    {0x00084000, Action::Remove},          // Identifying Comments
    {0x00100010, Action::Dummy},           // Patient's Name, Z: the pseudonym
    {0x00100020, Action::Dummy},           // Patient ID, Z/D: the pseudonym
    {0x00100030, Action::Empty},           // Patient's Birth Date, Z
    {0x00100040, Action::Characteristic},  // Patient's Sex, Z
    {0x00101010, Action::Characteristic},  // Patient's Age
    {0x00101020, Action::Characteristic},  // Patient's Size
    {0x00101030, Action::Characteristic},  // Patient's Weight
    {0x00180015, Action::Keep},            // Body Part Examined
    {0x00180022, Action::Keep},            // Scan Options
    {0x00180024, Action::Keep},            // Sequence Name
    {0x00181000, Action::Dummy},           // Device Serial Number, X/Z/D
    {0x00181002, Action::Uid},             // Device UID
    {0x00181020, Action::Keep},            // Software Versions
    {0x00181030, Action::Remove},          // Protocol Name
    {0x00181250, Action::Keep},            // Receive Coil Name
    {0x00181251, Action::Keep},            // Transmit Coil Name
    {0x00189005, Action::Keep},            // Pulse Sequence Name
    {0x0018A001, Action::Remove},          // Contributing Equipment Sequence
    {0x0020000D, Action::Uid},             // Study Instance UID
    {0x0020000E, Action::Uid},             // Series Instance UID
    {0x00200010, Action::Empty},           // Study ID, Z
    {0x00200052, Action::Uid},             // Frame of Reference UID
    {0x00200200, Action::Uid},             // Synchronization Frame of Reference UID
    {0x00201040, Action::Empty},           // Position Reference Indicator: free text, Type 2
    {0x00204000, Action::Remove},          // Image Comments
    {0x00209161, Action::Uid},             // Concatenation UID
    {0x00209164, Action::Uid},             // Dimension Organization UID
    {0x00282110, Action::Keep},            // Lossy Image Compression
    {0x00283003, Action::Dummy},           // LUT Explanation: Type 1 in real-world value maps
    {0x00400244, Action::Remove},          // Performed Procedure Step Start Date
    {0x00400245, Action::Remove},          // Performed Procedure Step Start Time
    {0x00400253, Action::Remove},          // Performed Procedure Step ID
    {0x00400254, Action::Remove},          // Performed Procedure Step Description
    {0x00400260, Action::Remove},          // Performed Protocol Code Sequence
    {0x00400275, Action::Remove},          // Request Attributes Sequence
    {0x00400555, Action::Empty},           // Acquisition Context Sequence, X/Z
    {0x0040A030, Action::Remove},          // Verification DateTime
    {0x0040A073, Action::Remove},          // Verifying Observer Sequence
    {0x0040A078, Action::Remove},          // Author Observer Sequence
    {0x0040A120, Action::Dummy},           // DateTime of a content item
    {0x0040A121, Action::Dummy},           // Date of a content item
    {0x0040A122, Action::Dummy},           // Time of a content item
    {0x0040A123, Action::Dummy},           // Person Name of a content item
    {0x0040A124, Action::Uid},             // UID of a content item
    {0x0040A160, Action::Dummy},           // Text Value
    {0x0040A372, Action::Empty},           // Performed Procedure Code Sequence, Type 2
    {0x0040A491, Action::Keep},            // Completion Flag
    {0x0040A493, Action::Keep},            // Verification Flag
    {0x0040DB00, Action::Keep},            // Template Identifier
    {0x00409210, Action::Keep},            // LUT Label
    {0x00620003, Action::Descend},         // Segmented Property Category Code Sequence
    {0x00620005, Action::Dummy},           // Segment Label
    {0x00620020, Action::Dummy},           // Tracking ID
    {0x00620021, Action::Uid},             // Tracking UID
    {0x00700080, Action::Dummy},           // Content Label
    {0x00700081, Action::Empty},           // Content Description, Type 2
    {0x00700084, Action::Empty},           // Content Creator's Name, Z
    {0x00880200, Action::Remove},          // Icon Image Sequence
    {0x04000500, Action::Remove},          // Encrypted Attributes Sequence
    {0x04000561, Action::Remove},          // Original Attributes Sequence
    {0x30060002, Action::Dummy},           // Structure Set Label, D
    {0x30060008, Action::Date},            // Structure Set Date, Z
    {0x30060009, Action::Empty},           // Structure Set Time, Z
    {0x30060024, Action::Uid},             // Referenced Frame of Reference UID
    {0x30060026, Action::Dummy},           // ROI Name, Z
    {0x300600A6, Action::Empty},           // ROI Interpreter, Z
    {0x300600C2, Action::Uid},             // Related Frame of Reference UID
    {0x300E0004, Action::Remove},          // Review Date
    {0x300E0008, Action::Remove},          // Reviewer Name
    {0xFFFAFFFA, Action::Remove},          // Digital Signatures Sequence
    {0xFFFCFFFC, Action::Remove},          // Data Set Trailing Padding
};

std::uint32_t number(const DcmTagKey& tag) {
  return static_cast<std::uint32_t>(tag.getGroup()) << 16 | tag.getElement();
}

/// Codes and short words that the standard, not a person, chooses.
bool isCoded(std::uint32_t tag) {
  constexpr std::array<std::uint32_t, 12> coded = {0x00080100, 0x00080102, 0x00080104, 0x00080103,
                                                   0x00080105, 0x0008010B, 0x0008010F, 0x00080112,
                                                   0x00080115, 0x00281054, 0x00209421, 0x00400440};
  return std::find(coded.begin(), coded.end(), tag) != coded.end();
}

}  // namespace

Action actionFor(DcmElement& element) {
  const DcmTagKey key(element.getGTag(), element.getETag());
  const std::uint32_t tag = number(key);
  const auto* row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& r) { return r.tag == tag; });
  if (row != std::end(rows)) return row->action;
  const std::uint32_t group = tag >> 16;
  if ((group & 1U) != 0) return Action::Remove;  // private; the safe list is asked before
  const std::uint32_t repeating = group >> 8;
  if (repeating == 0x50 || repeating == 0x60) return Action::Remove;  // curves and overlays
  if (group == 0x0010 || group == 0x0012 || group == 0x0032 || group == 0x0038 || group == 0x4008 || group == 0x4000)
    return Action::Remove;  // patient, trial, order, visit, interpretation
  if (isCoded(tag)) return Action::Keep;
  switch (element.ident()) {
    case EVR_SQ: return Action::Descend;
    case EVR_UI:
      return tag == 0x00080016 || tag == 0x00081150 || tag == 0x0008010C || tag == 0x00080117 || tag == 0x0008010D ||
                     tag == 0x00080118
                 ? Action::Keep  // classes and context groups of the standard
                 : Action::Uid;
    case EVR_CS:
    case EVR_DS:
    case EVR_IS:
    case EVR_US:
    case EVR_SS:
    case EVR_UL:
    case EVR_SL:
    case EVR_FL:
    case EVR_FD:
    case EVR_AT:
    case EVR_xs:
    case EVR_lt: return Action::Keep;
    case EVR_OB:
    case EVR_OW:
    case EVR_OF:
    case EVR_OD:
    case EVR_ox: return group == 0x0028 || group == 0x7FE0 || group == 0x0066 ? Action::Keep : Action::Remove;
    default:  // words, names, dates, ages, addresses, unknown bytes
      return Action::Remove;
  }
}

bool isSafePrivate(const std::string& creator, const DcmTagKey& tag) {
  struct Safe {
    const char* creator;
    std::uint16_t group;
    std::uint16_t element;  // last two digits
  };
  // Pulse sequence name and b-values of GE, scale of Philips, all of them rows of table E.3.10-1 or plain numbers.
  constexpr Safe safe[] = {{"GEMS_ACQU_01", 0x0019, 0x9C},
                           {"GEMS_PARM_01", 0x0043, 0x39},
                           {"Philips MR Imaging DD 005", 0x2005, 0x0D},
                           {"Philips MR Imaging DD 005", 0x2005, 0x0E}};
  return std::any_of(std::begin(safe), std::end(safe), [&](const Safe& s) {
    return creator == s.creator && tag.getGroup() == s.group && (tag.getElement() & 0xFF) == s.element;
  });
}

}  // namespace glisson::dicom
