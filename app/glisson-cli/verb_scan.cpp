// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "diagnostics_json.h"
#include "dicom/acquisitions.h"
#include "dicom/series.h"
#include "dicom/thumbnail.h"
#include "render/picture.h"
#include "roles_option.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct ScanArguments {
  std::filesystem::path path, thumbnails;
  std::vector<std::string> roles;
};

Json toJson(const dicom::Series& s) {
  Json j;
  j["uid"] = s.uid;
  j["role"] = name(s.role);
  j["role_reason"] = s.roleReason;
  j["description"] = s.description;
  j["modality"] = s.modality;
  j["number"] = s.number;
  j["slices"] = s.grid.size.z();
  j["rows"] = s.grid.size.y();
  j["columns"] = s.grid.size.x();
  j["spacing_mm"] = {s.grid.spacing_mm.x(), s.grid.spacing_mm.y(), s.grid.spacing_mm.z()};
  j["origin_lps_mm"] = {s.grid.origin_lps_mm.x(), s.grid.origin_lps_mm.y(), s.grid.origin_lps_mm.z()};
  Json d = Json::array();
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 3; ++c) d.push_back(s.grid.direction(c, axis));
  j["direction"] = d;
  if (s.unit) j["unit"] = *s.unit;
  if (s.temporalIndex >= 0) j["time_step"] = s.temporalIndex;
  if (s.encodingDirection >= 0) j["encoding_direction"] = s.encodingDirection;
  if (s.vibration_Hz) j["vibration_Hz"] = *s.vibration_Hz;
  j["lossy"] = s.lossy;
  j["warnings"] = s.warnings;
  j["diagnostics"] = diagnosticsJson(s.diagnostics, s.warnings);
  if (s.quantity) j["quantity"] = dicom::inWords(*s.quantity);
  if (s.error) {
    j["warnings"].push_back("cannot be used as a volume: " + *s.error);
    j["error"] = *s.error;
  }
  return j;
}

/// What belongs together, by the uid of its series; null where there is none.
Json toJson(const dicom::Acquisition& a, const dicom::ScanResult& found) {
  const auto uid = [&found](int i) {
    return i < 0 ? Json(nullptr) : Json(found.series[static_cast<std::size_t>(i)].uid);
  };
  Json wave = Json::array(), others = Json::array();
  for (const int w : a.wave) wave.push_back(uid(w));
  for (const int s : a.otherStiffness) others.push_back(uid(s));
  Json products = {{"magnitude", uid(a.magnitude)},
                   {"wave", wave},
                   {"stiffness", uid(a.stiffness)},
                   {"confidence", uid(a.confidence)}};
  if (!others.empty()) products["other_stiffness"] = others;
  return {{"products", products},
          {"why", a.why},
          {"warnings", a.diagnostics.texts(Severity::Warning)},
          {"diagnostics", diagnosticsJson(a.diagnostics)}};
}

/// Patients and their studies as indices into the list of series; nothing that says who they are.
Json patientsOf(const dicom::ScanResult& found) {
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, Json>>>> patients;
  for (std::size_t i = 0; i < found.series.size(); ++i) {
    const dicom::Series& s = found.series[i];
    auto patient =
        std::find_if(patients.begin(), patients.end(), [&](const auto& p) { return p.first == s.patientKey; });
    if (patient == patients.end()) patient = patients.insert(patients.end(), {s.patientKey, {}});
    auto& studies = patient->second;
    auto study = std::find_if(studies.begin(), studies.end(), [&](const auto& t) { return t.first == s.studyUid; });
    if (study == studies.end()) study = studies.insert(studies.end(), {s.studyUid, Json::array()});
    study->second.push_back(i);
  }
  Json all = Json::array();
  for (const auto& [key, studies] : patients) {
    Json list = Json::array();
    for (const auto& [uid, series] : studies) list.push_back({{"series", series}});
    all.push_back({{"studies", list}});
  }
  return all;
}

/// Writes a picture named after the place in the list, the series number and the role: nothing of the patient.
void addThumbnail(const dicom::Series& s, std::size_t place, const std::filesystem::path& folder, Json& j) {
  const dicom::Thumbnail small = dicom::thumbnail(s);
  if (small.width == 0) {
    j["thumbnail"] = nullptr;
    j["thumbnail_reason"] = small.whyNone;
    return;
  }
  render::Picture picture{small.width, small.height, {}};
  for (const std::uint8_t grey : small.grey) picture.rgb.insert(picture.rgb.end(), 3, grey);
  const std::string file =
      "series-" + std::to_string(place) + "-" + std::to_string(s.number) + "-" + name(s.role) + ".png";
  render::writePng(folder / file, picture, 96.0);
  j["thumbnail"] = file;
}

int scan(const ScanArguments& a, const Context& context) {
  dicom::ScanResult found = dicom::scan(a.path, context.progress());
  const dicom::RoleOverrides roles = rolesFrom(a.roles);
  for (const std::string& missing : dicom::applyRoles(found, roles))
    throw BadInput("no series has the UID or number '" + missing.substr(0, 70) + "' that a role was given for");
  if (!a.thumbnails.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(a.thumbnails, failed);
    if (failed) throw BadInput("the folder for thumbnails cannot be made: " + failed.message());
  }
  Json j;
  j["series"] = Json::array();
  j["skipped"] = Json::array();
  std::ostringstream text;
  for (const dicom::Series& s : found.series) {
    Json one = toJson(s);
    if (!a.thumbnails.empty()) addThumbnail(s, j["series"].size() + 1, a.thumbnails, one);
    j["series"].push_back(std::move(one));
    text << s.number << "  " << name(s.role) << "  " << s.modality << "  " << s.grid.size.x() << " x "
         << s.grid.size.y() << " x " << s.grid.size.z() << "  (" << s.grid.spacing_mm.transpose() << ") mm  "
         << s.description << "\n      " << s.roleReason << "\n";
    for (const std::string& w : s.warnings) text << "      warning: " << w << "\n";
    if (s.error) text << "      cannot be used as a volume: " << *s.error << "\n";
  }
  for (const dicom::SkippedFile& f : found.skipped) {
    j["skipped"].push_back({{"file", f.file.string()}, {"reason", f.reason}});
    text << "skipped " << f.file.string() << ": " << f.reason << "\n";
  }
  Diagnostics all;
  std::vector<std::string> warnings;
  for (const dicom::Series& s : found.series) {
    all.add(s.diagnostics);
    warnings.insert(warnings.end(), s.warnings.begin(), s.warnings.end());
    if (s.error) warnings.push_back("series " + std::to_string(s.number) + " cannot be used as a volume: " + *s.error);
  }
  j["acquisitions"] = Json::array();
  for (const dicom::Acquisition& one : dicom::acquisitions(found)) {
    j["acquisitions"].push_back(toJson(one, found));
    all.add(one.diagnostics);
    for (const std::string& w : one.diagnostics.texts(Severity::Warning)) text << "warning: " << w << "\n";
  }
  j["patients"] = patientsOf(found);
  const bool none = found.series.empty();
  if (none) all.add(DiagnosticCode::NoImageSeries, {{"files", static_cast<std::int64_t>(found.skipped.size())}});
  j["diagnostics"] = diagnosticsJson(all, warnings);
  if (!none) refuseIfStrict(context, all, warnings);
  context.print(j, text.str());
  if (!none) return Ok;
  throw BadInput(all.texts(Severity::Error).front() +
                 (found.skipped.empty() ? std::string() : ": " + found.skipped.front().reason) +
                 "; give the folder or file that holds the images");
}

}  // namespace

void addScan(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("scan", "list the series of a folder: roles with reasons, geometry, warnings, skipped files");
  auto a = std::make_shared<ScanArguments>();
  verb->add_option("path", a->path, "DICOM folder or file, DICOMDIR or ZIP archive")
      ->type_name(value::folderOrFile)
      ->required();
  verb->add_option("--thumbnails", a->thumbnails, "folder for one PNG of each series' middle slice")
      ->type_name(value::folder);
  verb->add_option("--role", a->roles, "series=role, set by hand: UID or number, and stiffness, wave, magnitude ...");
  verb->callback([&context, a] { context.action = [&context, a] { return scan(*a, context); }; });
}

}  // namespace glisson::cli
