// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/error.h"
#include "dicom/deidentify.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct DeidentifyArguments {
  std::filesystem::path in, out, key;
  dicom::DeidentifyOptions options;
};

}  // namespace

void addDeidentify(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand(
      "deidentify", "copies of DICOM files without what identifies the patient (PS3.15 basic profile, and stricter)");
  auto a = std::make_shared<DeidentifyArguments>();
  verb->add_option("in", a->in, "DICOM folder or file")->type_name(value::folderOrFile)->required();
  verb->add_option("out", a->out, "folder for the copies, new or empty")->type_name(value::folder)->required();
  verb->add_option("--key", a->key, "key file of the project, made where it is missing; keep it apart from results")
      ->type_name(value::file)
      ->required();
  verb->add_flag("--shift-dates", a->options.shiftDates, "keep dates, all of one patient shifted by the same days");
  verb->add_flag("--clean-descriptors", a->options.cleanDescriptors, "describe series by their role");
  verb->add_flag("--keep-characteristics", a->options.keepCharacteristics, "keep age, sex, size and weight");
  verb->callback([&context, a] {
    context.action = [&context, a] {
      const dicom::ProjectKey key = dicom::openProjectKey(a->key, {a->in, a->out});
      const dicom::DeidentifyResult r = dicom::deidentify(a->in, a->out, key, a->options, context.progress());
      // A left-out file is told by its place in the list: its name may be the patient's.
      Json j;
      j["files"] = Json::array();
      for (const auto& f : r.files) j["files"].push_back(f.string());
      j["left_out"] = Json::array();
      std::ostringstream text;
      text << r.files.size() << " files written\n";
      for (const dicom::SkippedFile& s : r.leftOut) {
        j["left_out"].push_back({{"reason", s.reason}});
        text << "left out: a file that " << s.reason << "\n";
      }
      j["notes"] = r.notes;
      for (const std::string& n : r.notes) text << "note: " << n << "\n";
      context.print(j, text.str());
      return r.leftOut.empty() ? Ok : r.files.empty() ? BadInputCode : PartialBatch;
    };
  });
}

}  // namespace glisson::cli
