// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "pipeline/replay.h"
#include "verbs.h"

namespace glisson::cli {

void addReplay(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("replay", "compute a run again and compare every output with its record");
  auto record = std::make_shared<std::filesystem::path>();
  auto options = std::make_shared<pipeline::ReplayOptions>();
  verb->add_option("record", *record, "run.json, or the folder of the run")->type_name(value::fileOrFolder)->required();
  verb->add_option("--scene", options->scene, "the scene, where it does not lie beside the record")
      ->type_name(value::file);
  verb->add_option("--root", options->root, "folder where the inputs are now, where they have moved")
      ->type_name(value::folder);
  verb->callback([&context, record, options] {
    context.action = [&context, record, options] {
      options->output = context.output;
      const pipeline::ReplayResult r = pipeline::replay(*record, *options, context.progress());
      Json j;
      j["identical"] = r.identical();
      j["numbers_identical"] = r.numbersIdentical;
      j["outputs"] = Json::array();
      std::ostringstream text;
      text << (r.identical() ? "identical\n" : "NOT identical\n")
           << "  numbers: " << (r.numbersIdentical ? "the same bits" : "differ") << "\n";
      for (const pipeline::ReplayedFile& f : r.outputs) {
        j["outputs"].push_back({{"file", f.file},
                                {"identical", f.identical()},
                                {"recorded_sha256", f.recorded},
                                {"found_sha256", f.found}});
        text << "  " << f.file << ": "
             << (f.identical()        ? "the same bits"
                 : f.found.empty()    ? "was not written again"
                 : f.recorded.empty() ? "was not there before"
                                      : "differs")
             << "\n";
      }
      j["changed"] = r.changed;
      j["notes"] = r.notes;
      for (const std::string& note : r.notes) text << "note        " << note << "\n";
      context.print(j, text.str());
      return r.identical() ? Ok : Failed;
    };
  });
}

}  // namespace glisson::cli
