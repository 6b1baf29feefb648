// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/private_folder.h"
#include "base/quantity_names.h"
#include "diagnostics_json.h"
#include "pipeline/export.h"
#include "slicer_xml.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

/// --strict: nothing is put into the output folder before it is known that there is no doubt.
pipeline::Exported exportIfSound(pipeline::ExportRequest request, const Context& context) {
  const std::filesystem::path output = request.output;
  const PrivateFolder scratch;
  request.output = scratch.path();
  pipeline::Exported done = pipeline::exportFiles(request, context.progress());
  refuseIfStrict(context, done.diagnostics, done.warnings);
  for (std::filesystem::path& f : done.files) {
    const std::filesystem::path to = output / std::filesystem::relative(f, scratch.path());
    std::error_code failed;
    std::filesystem::create_directories(to.parent_path(), failed);
    if (!failed) std::filesystem::copy_file(f, to, std::filesystem::copy_options::overwrite_existing, failed);
    if (failed) throw BadInput("the output folder cannot be written to; choose another with --output");
    f = to;
  }
  return done;
}

}  // namespace

void addExport(CLI::App& app, Context& context) {
  std::string names;
  for (const pipeline::ExportFormat& f : pipeline::exportFormats())
    names += "\n  " + f.name + std::string(f.name.size() < 10 ? 10 - f.name.size() : 1, ' ') + f.gives;
  CLI::App* verb = app.add_subcommand("export", "standard files of a scene or a run, by --to:" + names);
  auto request = std::make_shared<pipeline::ExportRequest>();
  auto quantity = std::make_shared<std::string>();
  verb->add_option("source", request->source, "scene.json, case.json, or the folder of a run")
      ->type_name(value::fileOrFolder)
      ->required();
  verb->add_option("--to", request->formats, "formats, separated by commas")->required()->delimiter(',');
  verb->add_option("--quantity", *quantity, "modulus of exported stiffness, where it is not the measured one")
      ->check(CLI::IsMember(stiffnessQuantityNames.words()));
  verb->add_option("--case", request->caseName, "case of tidy tables (never taken from the patient)");
  verb->add_option("--reader", request->reader, "reader of tidy tables");
  addSlicerXml(*verb, {"Export a result", {PathKind::Folder}});
  verb->callback([&context, request, quantity] {
    context.action = [&context, request, quantity] {
      if (context.output.empty()) throw BadInput("export needs a folder to write to: give --output");
      request->output = context.output;
      request->seed = context.seed;
      if (!quantity->empty()) request->quantity = stiffnessQuantityNames.named(*quantity);
      pipeline::Exported done;
      if (context.strict)
        done = exportIfSound(*request, context);
      else
        done = pipeline::exportFiles(*request, context.progress());
      Json j;
      j["formats"] = request->formats;
      j["files"] = Json::array();
      std::ostringstream text;
      for (const auto& f : done.files) {
        j["files"].push_back(f.string());
        text << "written " << f.string() << "\n";
      }
      j["warnings"] = done.warnings;
      j["diagnostics"] = diagnosticsJson(done.diagnostics, done.warnings);
      for (const std::string& w : done.warnings) text << "warning: " << w << "\n";
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
