// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/write_again.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "pipeline/detail/outputs.h"
#include "pipeline/detail/record.h"

namespace glisson::pipeline {
namespace {

namespace fs = std::filesystem;

void copyFile(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  fs::create_directories(to.parent_path(), failed);
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, failed);
  if (failed)
    throw BadInput("cannot copy " + to.filename().string() + " into the folder: " + failed.message() +
                   "; is the disk full or the folder read-only?");
}

}  // namespace

void writeAgain(const RunResult& result, const WriteAgain& where, std::vector<fs::path>& written,
                const Progress& progress) {
  std::error_code failed;
  fs::create_directories(where.into, failed);
  if (fs::equivalent(where.from, where.into, failed))
    throw BadInput("the folder is the one of the run itself; choose another");
  const Scene scene = readScene(where.from / "scene.json");
  RunResult r = result;
  r.files.clear();
  detail::Writer writer(where.into, r.files);
  const auto note = [&] {
    for (const fs::path& file : r.files)
      if (std::find(written.begin(), written.end(), file) == written.end()) written.push_back(file);
  };
  // In the order of the run: the report numbers its figures by it.
  bool drawn = false;
  const Language language = detail::languageOf(result.json);
  for (const fs::path& file : result.files) {
    const fs::path name = file.lexically_relative(where.from);
    if (name == "run.json" || name == "scene.json" || name.stem() == "report") continue;
    if (name.extension() != ".png") {
      r.files.push_back(where.into / name);
      note();
      copyFile(file, r.files.back());
    } else if (!std::exchange(drawn, true)) {
      const PictureData data = readPictureFile(where.from / pictureFileName);
      const bool solid = std::any_of(result.files.begin(), result.files.end(), [](const fs::path& f) {
        return f.filename().string().rfind("overlay-3d", 0) == 0;
      });
      progress.report(0.1, "slices");
      writer.sliceOverlays(data, where.palette);
      writer.charts(data);
      note();
      progress.report(0.4, "3-D");
      if (solid) writer.overlays3D(data, where.palette);
      writer.howSure(data, language);
      if (solid) writer.howSure3D(data, where.palette, language);
      note();
    }
  }
  progress.report(0.8, "report");
  const bool reported = std::any_of(result.files.begin(), result.files.end(),
                                    [](const fs::path& f) { return f.filename() == "report.html"; });
  if (reported) {
    for (const char* name : {"report.html", "report.pdf"}) written.push_back(where.into / name);
    writer.report(scene, r, detail::inputDigestsOf(result.json), where.palette, language);
  }
  written.push_back(where.into / "run.json");
  writer.text("run.json", detail::recordOfFiles(result.json, r.files, where.beside, where.palette) + "\n");
  progress.report(1.0, "done");
}

}  // namespace glisson::pipeline
