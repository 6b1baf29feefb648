#include <sstream>

#include "base/error.h"
#include "dicom/series.h"
#include "dicom/thumbnail.h"
#include "render/picture.h"
#include "roles_option.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct Arguments {
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
  if (s.error) {
    j["warnings"].push_back("cannot be used as a volume: " + *s.error);
    j["error"] = *s.error;
  }
  return j;
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

int scan(const Arguments& a, const Context& context) {
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
  if (found.series.empty()) text << "no image series found\n";
  context.print(j, text.str());
  return Ok;
}

}  // namespace

void addScan(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("scan", "list the series of a folder: roles with reasons, geometry, warnings, skipped files");
  auto a = std::make_shared<Arguments>();
  verb->add_option("path", a->path, "DICOM folder or file, DICOMDIR or ZIP archive")->required();
  verb->add_option("--thumbnails", a->thumbnails, "folder for one PNG of each series' middle slice");
  verb->add_option("--role", a->roles, "series=role, set by hand: UID or number, and stiffness, wave, magnitude ...");
  verb->callback([&context, a] { context.action = [&context, a] { return scan(*a, context); }; });
}

}  // namespace glisson::cli
