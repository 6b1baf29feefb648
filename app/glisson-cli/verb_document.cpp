// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "manual_pages.h"
#include "verbs.h"

namespace glisson::cli {

void addDocument(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand(
      "document", "manual pages and completion of this program, from its own options, written to the folder --output");
  verb->callback([&app, &context] {
    context.action = [&app, &context] {
      if (context.output.empty()) throw BadInput("document needs a folder to write to: give --output");
      // The table holds what options are before any is given: --output of this call is not its default.
      const std::filesystem::path folder = std::exchange(context.output, {});
      context.threads = 0;
      const VerbRow table = tableOf(app);
      std::vector<std::pair<std::string, std::string>> files = manualPages(table);
      files.emplace_back(table.name + ".bash", bashCompletion(table));
      std::error_code failed;
      std::filesystem::create_directories(folder, failed);
      Json j = {{"files", Json::array()}};
      std::string text;
      for (const auto& [name, content] : files) {
        writeAtomically(folder / name, content);
        j["files"].push_back((folder / name).string());
        text += "written " + (folder / name).string() + "\n";
      }
      context.print(j, text);
      return Ok;
    };
  });
}

}  // namespace glisson::cli
