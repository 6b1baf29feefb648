// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "base/error.h"
#include "base/sha256.h"
#include "pipeline/pictures.h"
#include "pipeline/replay.h"
#include "render/backend.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct RenderArguments {
  std::filesystem::path run;
  std::vector<std::string> cameras;
  std::vector<int> slices;
  std::string palette = "red-blue", size = "1600x1200", language = "en";
  double dpi = 300.0;
};

/// "1600x1200"
void readSize(const std::string& text, pipeline::PictureOptions& o) {
  std::istringstream in(text);
  char x = 0;
  if (!(in >> o.width >> x >> o.height) || x != 'x' || in.peek() != std::char_traits<char>::eof() || o.width < 64 ||
      o.height < 64 || o.width > 8000 || o.height > 8000)
    throw BadInput("the size \"" + text +
                   "\" is not usable: give width and height in pixels (64 to 8000), as 1600x1200");
}

}  // namespace

void addRender(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand("render", "draw the pictures of a run again: other cameras, palettes or slices");
  auto a = std::make_shared<RenderArguments>();
  verb->add_option("run", a->run, "folder of the run, or its run.json")->type_name(value::folderOrFile)->required();
  verb->add_option("--camera", a->cameras,
                   "anterior, posterior, left, right, superior, inferior, oblique, or --camera=azimuth,elevation in "
                   "degrees; may be given several times");
  verb->add_option("--slice", a->slices, "slice of the image, from 0; may be given several times");
  verb->add_option("--palette", a->palette, "colours")->check(CLI::IsMember({"red-blue", "colour-blind"}));
  verb->add_option("--size", a->size, "width x height of 3-D pictures in pixels; slices grow with the width");
  verb->add_option("--language", a->language, "of the pictures of how sure the answer is: en or de")
      ->check(CLI::IsMember({"en", "de"}));
  verb->add_option("--dpi", a->dpi, "resolution written into the pictures")->check(CLI::Range(1.0, 10000.0));
  verb->callback([&context, a] {
    context.action = [&context, a] {
      render::setRenderBackend(context.renderBackend == "egl"   ? render::RenderBackend::Egl
                               : context.renderBackend == "x11" ? render::RenderBackend::X11
                                                                : render::RenderBackend::Auto);
      pipeline::PictureOptions o;
      o.palette = a->palette == "colour-blind" ? render::Palette::ColourBlind : render::Palette::RedBlue;
      o.language = languageNamed(a->language);
      o.slices = a->slices;
      for (const std::string& camera : a->cameras) o.cameras.push_back(pipeline::cameraFromText(camera));
      readSize(a->size, o);
      o.dpi = a->dpi;
      const bool byRecord = std::filesystem::is_regular_file(a->run);
      const std::filesystem::path run = byRecord ? a->run.parent_path() : a->run;
      if (const auto record = pipeline::recordOf(a->run); std::filesystem::is_regular_file(record))
        for (const std::string& name : pipeline::filesOfAnotherRun(record))
          if (name == pipeline::pictureFileName)
            throw BadInput(
                "the pictures' data in this folder are not those of its run.json: another run has written "
                "into it; run the scene again into a folder of its own");
      const pipeline::PictureData data = pipeline::readPictureFile(run / pipeline::pictureFileName);
      if (!data.scene.valid)
        throw BadInput("this run did not converge, or gave no deformation: it is not drawn; see run.json");
      const std::filesystem::path folder = context.output.empty() ? run : context.output;
      std::filesystem::create_directories(folder);
      // Slices alone need no OpenGL, so it is not started for them.
      std::vector<std::filesystem::path> files;
      if (o.cameras.empty() || !o.slices.empty()) files = pipeline::drawSlices(data, o, folder);
      if (o.slices.empty() && o.cameras.empty())
        for (const auto& f : pipeline::drawCharts(data, o, folder)) files.push_back(f);
      if (o.cameras.empty() || !o.slices.empty())
        for (const auto& f : pipeline::drawHowSure(data, o, folder)) files.push_back(f);
      if (o.slices.empty() || !o.cameras.empty())
        for (const auto draw : {pipeline::draw3D, pipeline::drawHowSure3D})
          for (const auto& f : draw(data, o, folder)) files.push_back(f);
      Json j;
      j["files"] = Json::array();
      std::ostringstream text;
      for (const auto& f : files) {
        j["files"].push_back({{"file", f.filename().string()}, {"sha256", sha256OfFile(f)}});
        text << "written     " << f.string() << "\n";
      }
      context.print(j, text.str());
      return Ok;
    };
  });
}

}  // namespace glisson::cli
