#include <sstream>

#include "dicom/series.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

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
  j["warnings"] = s.warnings;
  if (s.error) {
    j["warnings"].push_back("cannot be used as a volume: " + *s.error);
    j["error"] = *s.error;
  }
  return j;
}

}  // namespace

void addScan(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("scan", "list the series of a folder: roles with reasons, geometry, warnings, skipped files");
  auto path = std::make_shared<std::filesystem::path>();
  verb->add_option("path", *path, "DICOM folder or file")->required();
  verb->callback([&context, path] {
    context.action = [&context, path] {
      const dicom::ScanResult scan = dicom::scan(*path, context.progress());
      Json j;
      j["series"] = Json::array();
      j["skipped"] = Json::array();
      std::ostringstream text;
      for (const dicom::Series& s : scan.series) {
        j["series"].push_back(toJson(s));
        text << s.number << "  " << name(s.role) << "  " << s.modality << "  " << s.grid.size.x() << " x "
             << s.grid.size.y() << " x " << s.grid.size.z() << "  (" << s.grid.spacing_mm.transpose() << ") mm  "
             << s.description << "\n      " << s.roleReason << "\n";
        for (const std::string& w : s.warnings) text << "      warning: " << w << "\n";
        if (s.error) text << "      cannot be used as a volume: " << *s.error << "\n";
      }
      for (const dicom::SkippedFile& f : scan.skipped) {
        j["skipped"].push_back({{"file", f.file.string()}, {"reason", f.reason}});
        text << "skipped " << f.file.string() << ": " << f.reason << "\n";
      }
      if (scan.series.empty()) text << "no image series found\n";
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
