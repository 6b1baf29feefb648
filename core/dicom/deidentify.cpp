// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/deidentify.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "base/error.h"
#include "base/text.h"
#include "dicom/detail/attributes.h"
#include "dicom/detail/clean_copy.h"
#include "dicom/detail/deidentify_actions.h"
#include "dicom/detail/writer.h"
#include "dicom/write_mr.h"

namespace glisson::dicom {
namespace {

struct Case {
  const ProjectKey& key;
  const DeidentifyOptions& options;
  std::string pseudonym;
  int shift_days = 0;
  std::string description;  ///< for SeriesDescription, words of our own
  int structures = 0;
  bool agesCut = false;
  AttributeChanges changes;
};

std::string mappedUid(const ProjectKey& key, const std::string& old) {
  return uidFrom("de-identified/" + keyedDigest(key, "uid/" + old));
}

/// One or several, separated by backslashes.
std::string mappedUids(const ProjectKey& key, const std::string& old) {
  std::string all;
  for (std::size_t begin = 0; begin <= old.size() && !old.empty();) {
    const std::size_t end = std::min(old.find('\\', begin), old.size());
    all += (all.empty() ? "" : "\\") + mappedUid(key, old.substr(begin, end - begin));
    begin = end + 1;
  }
  return all;
}

/// A date of the Gregorian calendar moved by days; empty where it is none.
std::string shiftedDate(const std::string& date, int days) {
  if (date.size() < 8 || date.find_first_not_of("0123456789") < 8) return {};
  using namespace std::chrono;
  const year_month_day old(year(std::stoi(date.substr(0, 4))),
                           month(static_cast<unsigned>(std::stoi(date.substr(4, 2)))),
                           day(static_cast<unsigned>(std::stoi(date.substr(6, 2)))));
  if (!old.ok()) return {};
  const year_month_day moved(sys_days(old) + std::chrono::days(days));
  char out[16];
  std::snprintf(out, sizeof out, "%04d%02u%02u", static_cast<int>(moved.year()), static_cast<unsigned>(moved.month()),
                static_cast<unsigned>(moved.day()));
  return out;
}

/// Ages above 89 years identify, and are put together as 90: "094Y", or as months, weeks or days.
bool isOver89(const std::string& age) {
  if (age.size() < 2) return false;
  const double perYear = age.back() == 'D' ? 365.25 : age.back() == 'W' ? 52.18 : age.back() == 'M' ? 12.0 : 1.0;
  const std::string digits = age.substr(0, age.find_last_of("0123456789") + 1);
  return !digits.empty() && digits.size() < 6 && digits.find_first_not_of("0123456789") == std::string::npos &&
         std::stod(digits) / perYear >= 90.0;
}

/// A liver is called so in every language that its outline's name is searched for; all else gets a number.
std::string structureName(const std::string& name, int number) {
  return lowerCase(name).find("liver") != std::string::npos ? "liver" : "ROI " + std::to_string(number);
}

std::string dummyFor(DcmElement& element, const std::string& old, Case& c) {
  const DcmTagKey tag(element.getGTag(), element.getETag());
  if (tag == DCM_PatientName || tag == DCM_PatientID) return c.pseudonym;
  if (tag == DCM_ROIName || tag == DCM_SegmentLabel || tag == DCM_TrackingID) return structureName(old, ++c.structures);
  switch (element.ident()) {
    case EVR_DA: return "19000101";
    case EVR_TM: return "000000";
    case EVR_DT: return "19000101000000";
    default: return "REMOVED";
  }
}

/// The words of a description that say how an image was made; all other words go.
std::string knownWords(const std::string& description) {
  static constexpr const char* known[] = {
      "ax",     "axial",     "cor",        "coronal",      "sag",        "sagittal", "t1",    "t2",      "t1w",
      "t2w",    "dwi",       "adc",        "mre",          "mr",         "mri",      "lava",  "vibe",    "thrive",
      "fs",     "dixon",     "fat",        "water",        "in",         "out",      "phase", "opp",     "arterial",
      "portal", "venous",    "delayed",    "pre",          "post",       "gd",       "liver", "abdomen", "stiffness",
      "wave",   "magnitude", "confidence", "elastography", "elastogram", "map",      "2d",    "3d",      "pa",
      "kpa",    "30hz",      "40hz",       "50hz",         "60hz",       "80hz",     "epi",   "gre",     "se",
      "tse",    "fse",       "ssfse",      "haste"};
  std::string low, out;
  for (const char l : lowerCase(description) + " ") {
    if ((l >= 'a' && l <= 'z') || (l >= '0' && l <= '9')) {
      low += l;
      continue;
    }
    if (std::any_of(std::begin(known), std::end(known), [&](const char* k) { return low == k; }))
      out += (out.empty() ? "" : " ") + low;
    low.clear();
  }
  return out.substr(0, 64);
}

void clean(DcmItem& item, Case& c, int depth);

void setText(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  Writer(item).text(tag, value);
}

void treat(DcmItem& item, DcmElement& element, Case& c, int depth) {
  const DcmTagKey tag(element.getGTag(), element.getETag());
  switch (actionFor(element)) {
    case Action::Keep: return;
    case Action::Remove:
      ++((tag.getGroup() & 1U) != 0 ? c.changes.privateRemoved : c.changes.removed);
      item.findAndDeleteElement(tag);
      return;
    case Action::Empty:
      c.changes.emptied += element.getLength() > 0 ? 1 : 0;
      Writer::check(item.insertEmptyElement(tag, OFTrue), tag);
      return;
    case Action::Dummy:
      ++c.changes.replaced;
      setText(item, tag, dummyFor(element, shownText(item, tag), c));
      return;
    case Action::Uid:
      setText(item, tag, mappedUids(c.key, text(item, tag)));
      ++c.changes.uids;
      return;
    case Action::Date: {
      c.changes.dates += element.getLength() > 0 ? 1 : 0;
      const std::string moved = c.options.shiftDates ? shiftedDate(text(item, tag), c.shift_days) : std::string();
      const bool typed = tag == DCM_ContentDate;  // Type 1 in most objects
      setText(item, tag, !moved.empty() ? moved : typed ? "19000101" : "");
      return;
    }
    case Action::Characteristic:
      if (c.options.keepCharacteristics) {
        if (tag == DCM_PatientAge && isOver89(text(item, tag))) {
          setText(item, tag, "090Y");
          c.agesCut = true;
        }
        return;
      }
      if (tag == DCM_PatientSex) {
        c.changes.emptied += element.getLength() > 0 ? 1 : 0;
        setText(item, tag, "");
      } else {
        ++c.changes.removed;
        item.findAndDeleteElement(tag);
      }
      return;
    case Action::Descend: {
      auto* sequence = dynamic_cast<DcmSequenceOfItems*>(&element);
      if (sequence == nullptr || depth > 64) {
        ++c.changes.removed;
        item.findAndDeleteElement(tag);
        return;
      }
      for (DcmObject* o = sequence->nextInContainer(nullptr); o != nullptr; o = sequence->nextInContainer(o))
        clean(*static_cast<DcmItem*>(o), c, depth + 1);
      return;
    }
  }
}

/// Codes of private schemes may say anything: their meaning goes.
void cleanCode(DcmItem& item, Case& c) {
  const std::string scheme = text(item, DCM_CodingSchemeDesignator);
  if (scheme.empty()) return;
  static const char* known[] = {"DCM", "SCT", "SRT", "SNM3", "UCUM", "LN", "RFC5646", "FMA", "NCIt", "99GLISSON"};
  if (std::any_of(std::begin(known), std::end(known), [&](const char* k) { return scheme == k; })) return;
  ++c.changes.codes;
  setText(item, DCM_CodeValue, "REMOVED");
  setText(item, DCM_CodingSchemeDesignator, "99REMOVED");
  setText(item, DCM_CodeMeaning, "REMOVED");
}

void clean(DcmItem& item, Case& c, int depth) {
  std::vector<DcmTagKey> tags;
  for (DcmObject* o = item.nextInContainer(nullptr); o != nullptr; o = item.nextInContainer(o))
    tags.emplace_back(o->getGTag(), o->getETag());
  std::vector<DcmTagKey> safe;  // private attributes that stay, and the creators of their blocks
  for (const DcmTagKey& tag : tags) {
    if ((tag.getGroup() & 1U) == 0 || tag.getElement() < 0x1000) continue;
    const DcmTagKey creator(tag.getGroup(), static_cast<Uint16>(tag.getElement() >> 8));
    const std::string value = text(item, tag);
    // Names of sequences and numbers are in lower case; names of people are not.
    const bool plain =
        value.size() <= 32 && value.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.-\\") == std::string::npos;
    if (depth == 0 && plain && isSafePrivate(text(item, creator), tag)) {
      safe.push_back(tag);
      safe.push_back(creator);
    }
  }
  for (const DcmTagKey& tag : tags) {
    if (std::find(safe.begin(), safe.end(), tag) != safe.end()) continue;
    DcmElement* element = nullptr;
    if (item.findAndGetElement(tag, element).good() && element != nullptr) treat(item, *element, c, depth);
  }
  cleanCode(item, c);
}

void declare(DcmDataset& data, const Case& c) {
  Writer w(data);
  w.text(DCM_PatientIdentityRemoved, "YES");
  w.text(DCM_DeidentificationMethod, "Glisson: PS3.15 basic profile, stricter on free text");
  data.findAndDeleteElement(DCM_DeidentificationMethodCodeSequence);
  w.code(DCM_DeidentificationMethodCodeSequence, {"113100", "DCM", "Basic Application Confidentiality Profile"});
  w.code(DCM_DeidentificationMethodCodeSequence, {"113104", "DCM", "Clean Structured Content Option"});
  w.code(DCM_DeidentificationMethodCodeSequence, {"113111", "DCM", "Retain Safe Private Option"});
  if (c.options.cleanDescriptors)
    w.code(DCM_DeidentificationMethodCodeSequence, {"113105", "DCM", "Clean Descriptors Option"});
  if (c.options.shiftDates)
    w.code(DCM_DeidentificationMethodCodeSequence,
           {"113107", "DCM", "Retain Longitudinal Temporal Information Modified Dates Option"});
  if (c.options.keepCharacteristics)
    w.code(DCM_DeidentificationMethodCodeSequence, {"113108", "DCM", "Retain Patient Characteristics Option"});
  w.text(DCM_LongitudinalTemporalInformationModified, c.options.shiftDates ? "MODIFIED" : "REMOVED");
  if (!c.description.empty()) w.text(DCM_SeriesDescription, c.description);
  w.text(DCM_SpecificCharacterSet, "ISO_IR 192");
}

/// Why the pixels may show who the patient is; empty where nothing says so.
std::string pixelRisk(DcmDataset& data) {
  const std::string burned = text(data, DCM_BurnedInAnnotation), sopClass = text(data, DCM_SOPClassUID);
  if (burned == "YES") return "says that patient data are burned into its pixels";
  if (text(data, DCM_RecognizableVisualFeatures) == "YES")
    return "says that the patient can be recognised in its pixels";
  if (data.tagExists(DCM_EncapsulatedDocument)) return "holds an encapsulated document, which cannot be cleaned";
  if (burned == "NO") return {};
  const std::string type = text(data, DCM_ImageType);
  const bool captured = data.tagExists(DCM_ConversionType) || sopClass == UID_SecondaryCaptureImageStorage ||
                        type.find("SCREEN SAVE") != std::string::npos || text(data, DCM_Modality) == "OT";
  const bool colour = count(data, DCM_SamplesPerPixel).value_or(1) > 1;
  if (captured || colour) return "is a picture whose pixels may show who the patient is (no BurnedInAnnotation NO)";
  return {};
}

/// Words for what a series is; read again by setRoles.
std::string describe(const Series& s) {
  std::string words = s.role == SeriesRole::Other ? "" : "MR " + name(s.role);
  if (s.role == SeriesRole::Stiffness) words = "MRE stiffness" + (s.unit ? " (" + *s.unit + ")" : std::string());
  if (s.role == SeriesRole::Wave) words = "MRE wave";
  if (s.role == SeriesRole::Magnitude) words = "MRE magnitude";
  if (s.role == SeriesRole::Confidence) words = "MRE confidence";
  return words;
}

/// Throws BadInput where the folders cannot be what they are meant for.
void checkFolders(const std::filesystem::path& in, const std::filesystem::path& out) {
  // The output must not be read again as input.
  const std::filesystem::path whole = std::filesystem::weakly_canonical(in),
                              target = std::filesystem::weakly_canonical(out);
  if (std::mismatch(whole.begin(), whole.end(), target.begin(), target.end()).first == whole.end())
    throw BadInput("the output lies inside the input; choose a folder beside it");
  if (!std::filesystem::exists(in)) throw BadInput("there is nothing at the folder to de-identify");
  if (std::filesystem::exists(out) && !std::filesystem::is_empty(out))
    throw BadInput("the output folder is not empty; give a new one, so that nothing old is taken for de-identified");
}

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& in) {
  if (std::filesystem::is_regular_file(in)) return {in};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(in))
    if (!entry.is_symlink() && entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Throws BadInput, with the reason why a file is left out.
void checkFile(DcmDataset& data) {
  if (text(data, DCM_SOPClassUID) == UID_MediaStorageDirectoryStorage || data.tagExists(DCM_DirectoryRecordSequence))
    throw BadInput("is a directory of files (DICOMDIR), which names the patient");
  if (text(data, DCM_SOPInstanceUID).empty()) throw BadInput("has no SOP Instance UID");
  if (const std::string risk = pixelRisk(data); !risk.empty()) throw BadInput(risk);
}

/// What is done to the files of this patient, and what their series is called afterwards.
Case caseOf(DcmDataset& data, const ProjectKey& key, const DeidentifyOptions& options,
            const std::map<std::string, std::string>& descriptions) {
  const std::string patient =
      keyedDigest(key, "patient/" + unifiedText(data, DCM_PatientID) + "/" + unifiedText(data, DCM_IssuerOfPatientID) +
                           (text(data, DCM_PatientID).empty() ? unifiedText(data, DCM_PatientName) : std::string()));
  Case c{key, options, "G-" + patient.substr(0, 12), 0, {}, 0, false, {}};
  c.shift_days = -1 - static_cast<int>(std::stoul(patient.substr(12, 6), nullptr, 16) % 3650);
  const auto words = descriptions.find(text(data, DCM_SeriesInstanceUID));
  if (words != descriptions.end()) c.description = words->second;
  if (c.description.empty() && options.cleanDescriptors) c.description = knownWords(text(data, DCM_SeriesDescription));
  if (c.description.empty() && text(data, DCM_Manufacturer) == "Glisson")
    c.description = "RESEARCH " + text(data, DCM_Modality);
  return c;
}

void add(const AttributeChanges& one, AttributeChanges& all) {
  all.removed += one.removed;
  all.privateRemoved += one.privateRemoved;
  all.emptied += one.emptied;
  all.replaced += one.replaced;
  all.uids += one.uids;
  all.dates += one.dates;
  all.codes += one.codes;
}

/// The place of a cleaned file. Throws BadInput where there is one already.
std::filesystem::path placeOf(DcmDataset& data, const Case& c, const std::filesystem::path& out) {
  const auto folder = out / c.pseudonym / text(data, DCM_SeriesInstanceUID).substr(5, 16);
  std::filesystem::create_directories(folder);
  const auto file = folder / (text(data, DCM_SOPInstanceUID).substr(5, 24) + ".dcm");
  if (std::filesystem::exists(file)) throw BadInput("has the SOP Instance UID of another file");
  return file;
}

void addNotes(std::size_t agesCut, DeidentifyResult& result) {
  result.notes.push_back("PS3.15 basic profile; free text, names and dates beyond it are removed too");
  result.notes.push_back("the scanner's maker, model and software versions are kept");
  if (agesCut > 0)
    result.notes.push_back("ages of 90 years and more identify: they were written as 090Y, in " +
                           std::to_string(agesCut) + " files");
  if (!result.leftOut.empty())
    result.notes.push_back(std::to_string(result.leftOut.size()) + " files were left out, each with its reason");
}

}  // namespace

DeidentifyResult deidentify(const std::filesystem::path& in, const std::filesystem::path& out, const ProjectKey& key,
                            const DeidentifyOptions& options, const Progress& progress) {
  checkFolders(in, out);
  const ScanResult scanned = scan(in, progress.part(0.0, 0.3));
  std::map<std::string, std::string> descriptions;  // by SeriesInstanceUID
  for (const Series& s : scanned.series) descriptions.try_emplace(seriesInstanceUid(s), describe(s));
  const std::vector<std::filesystem::path> files = filesIn(in);
  DeidentifyResult result;
  std::size_t agesCut = 0;
  std::set<std::string> patients;
  std::filesystem::create_directories(out);
  for (std::size_t n = 0; n < files.size(); ++n) {
    progress.part(0.3, 1.0).report(static_cast<double>(n) / static_cast<double>(files.size()), "de-identifying");
    try {
      ByteSource source(files[n]);
      const FileLayout layout = readLayout(source);
      DcmDataset data;
      parseHeader(source, layout, data);
      checkFile(data);
      Case c = caseOf(data, key, options, descriptions);
      const std::string study = options.cleanDescriptors ? knownWords(text(data, DCM_StudyDescription)) : std::string();
      clean(data, c, 0);
      declare(data, c);
      if (!study.empty()) setText(data, DCM_StudyDescription, study);
      const std::filesystem::path file = placeOf(data, c, out);
      writeCleanCopy(data, source, layout, file);
      result.files.push_back(file);
      agesCut += c.agesCut ? 1 : 0;
      add(c.changes, result.changes);
      patients.insert(c.pseudonym);
    } catch (const BadInput& e) {
      result.leftOut.push_back({files[n], e.what()});
    }
  }
  addNotes(agesCut, result);
  result.patients = patients.size();
  progress.report(1.0, "de-identified");
  return result;
}

}  // namespace glisson::dicom
