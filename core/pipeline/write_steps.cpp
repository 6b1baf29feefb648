// SPDX-License-Identifier: GPL-3.0-or-later

// The steps of a run that write into its folder.
#include <malloc.h>

#include "base/error.h"
#include "exchange/sofa.h"
#include "pipeline/detail/record.h"
#include "pipeline/detail/step_works.h"
#include "retraction/offered.h"

namespace glisson::pipeline::detail::works {

void openFolder(RunState& s) {
  const std::filesystem::path& folder = s.options.output;
  s.writer.emplace(folder, s.result.files);
  s.claim.emplace(folder);
  // The record comes last: without it, nobody takes what a killed run has left for a result, nor for a former one's.
  for (const char* name : {"run.json", "report.html", "report.pdf"}) std::filesystem::remove(folder / name);
}

void writeDisplacements(RunState& s, const Progress&) {
  s.writer->displacementFields(s.result);
}

void writeTables(RunState& s) {
  RunResult& r = s.result;
  if (s.scene.outputs.vessels && s.needs.vessels) s.writer->vessels(s.scene, r, s.vessels);
  if (r.stiffness) s.writer->stiffness(*r.stiffness);
  if (!s.needs.pictures) return;
  s.pictures = s.writer->pictureData(r);
  r.picture.reset();  // one copy of the image is enough; given back at the end of the run
}

void writePictureData(RunState& s, const Progress&) {
  s.writer->pictureFile(*s.pictures);
}

void writeSlices(RunState& s, const Progress&) {
  s.writer->sliceOverlays(*s.pictures, s.options.palette);
  s.writer->charts(*s.pictures);
}

void writeOverlays3D(RunState& s, const Progress&) {
  malloc_trim(0);  // the heap keeps what the solves gave back, and drawing needs as much once more beside it
  try {
    s.writer->overlays3D(*s.pictures, s.options.palette);
  } catch (const RenderUnavailable& e) {
    // Everything but these pictures is there already; losing it for want of OpenGL would be worse than saying so.
    s.result.warnings.push_back(std::string("no 3-D picture was drawn: ") + e.what());
    s.log.leaveOut(StepId::Overlay3D, "it cannot be drawn here");
  }
}

void leaveOutHowSure(RunState& s) {
  if (!s.needs.pictures || !s.needs.uncertainty) return;
  if (!s.pictures || !s.pictures->sure)
    s.log.leaveOut(StepId::UncertaintyPictures, "how sure the run is could not be told");
  else if (!s.pictures->scene.valid)
    s.log.leaveOut(StepId::UncertaintyPictures, "what is no deformation is not drawn");
}

void writeHowSure(RunState& s, const Progress&) {
  s.writer->howSure(*s.pictures, s.options.language);
  try {
    s.writer->howSure3D(*s.pictures, s.options.palette, s.options.language);
  } catch (const RenderUnavailable&) {
    // The overlays have told it already.
    s.log.explain(StepId::UncertaintyPictures, "charts and map; the 3-D picture cannot be drawn here");
  }
}

void writeSofa(RunState& s, const Progress&) {
  RunResult& r = s.result;
  const exchange::SofaExport node = exchange::writeSofa(s.options.output / "sofa", r.model, s.scene.setup,
                                                        {s.vessels.centreline_lps_mm, s.vessels.edges});
  r.files.insert(r.files.end(), node.files.begin(), node.files.end());
  for (const std::string& n : node.notes) r.warnings.push_back("SOFA: " + n);
  r.diagnostics.add(retraction::notExportable(s.scene.setup));
}

void writeReport(RunState& s, const Progress&) {
  s.writer->report(s.scene, s.result, inputDigests(s.scene), s.options.palette, s.options.language);
}

}  // namespace glisson::pipeline::detail::works
