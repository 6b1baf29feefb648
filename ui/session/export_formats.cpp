// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export_formats.h"

#include <QtGlobal>
#include <algorithm>

#include "base/error.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;

/// Files are made in a hidden folder beside their place, so that each gets there as a whole.
class Making {
 public:
  explicit Making(const fs::path& folder) : path_(folder / ".glisson-export-making") {
    std::error_code failed;
    fs::remove_all(path_, failed);
    fs::create_directories(path_, failed);
    if (!fs::is_directory(path_, failed))
      throw BadInput("the folder for the export cannot be written to; choose another");
  }
  ~Making() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Making(const Making&) = delete;
  Making& operator=(const Making&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void checkFolder(const ExportWish& wish) {
  std::error_code failed;
  if (wish.formats.empty()) throw BadInput("no format is chosen; tick at least one");
  if (wish.folder.empty()) throw BadInput("no folder is chosen");
  if (fs::exists(wish.folder, failed) && !fs::is_directory(wish.folder, failed))
    throw BadInput("there is a file where the folder should be; choose another");
  if (!wish.replace && fs::is_directory(wish.folder, failed) && !fs::is_empty(wish.folder, failed))
    throw BadInput("the folder is not empty; choose a new one, or allow that files of the same name are replaced");
}

}  // namespace

const std::vector<FormatOffer>& formatOffers() {
  using G = FormatGroup;
  using N = FormatNeeds;
  static const std::vector<FormatOffer> offers = {
      {"rtstruct", G::Dicom, N::Outlines, QT_TRANSLATE_NOOP("formats", "RT Structure Set of the outlines")},
      {"seg", G::Dicom, N::Outlines, QT_TRANSLATE_NOOP("formats", "Segmentation of the liver")},
      {"pmap", G::Dicom, N::Elastogram, QT_TRANSLATE_NOOP("formats", "Parametric Map of the stiffness in kPa")},
      {"sr", G::Dicom, N::Elastogram, QT_TRANSLATE_NOOP("formats", "Structured report of the stiffness (TID 1500)")},
      {"sc", G::Dicom, N::Run, QT_TRANSLATE_NOOP("formats", "Pictures of the run as Secondary Captures")},
      {"nifti", G::Images, N::Outlines, QT_TRANSLATE_NOOP("formats", "Liver mask as NIfTI")},
      {"seg-nrrd", G::Images, N::Outlines, QT_TRANSLATE_NOOP("formats", "Liver mask as 3D Slicer segmentation")},
      {"contours", G::Images, N::Outlines, QT_TRANSLATE_NOOP("formats", "Outlines as JSON")},
      {"markups", G::Images, N::Outlines, QT_TRANSLATE_NOOP("formats", "Outlines as 3D Slicer markups")},
      {"field", G::Images, N::Run, QT_TRANSLATE_NOOP("formats", "Displacement field as 4-D NRRD")},
      {"vtu", G::Meshes, N::Run, QT_TRANSLATE_NOOP("formats", "VTK meshes, at rest and deformed (ParaView)")},
      {"mtx", G::Meshes, N::Run, QT_TRANSLATE_NOOP("formats", "Stiffness and mass matrix as Matrix Market")},
      {"slicer", G::Programs, N::Run, QT_TRANSLATE_NOOP("formats", "3D Slicer scene with images, outlines, surfaces")},
      {"sofa", G::Programs, N::Run, QT_TRANSLATE_NOOP("formats", "SOFA scene")},
      {"csv", G::Tables, N::Run, QT_TRANSLATE_NOOP("formats", "Stiffness and displacement as a table (CSV)")},
  };
  return offers;
}

bool has(const ExportSource& source, FormatNeeds needs) {
  switch (needs) {
    case FormatNeeds::Outlines: return source.outlines;
    case FormatNeeds::Elastogram: return source.outlines && source.files.images.stiffness != nullptr;
    case FormatNeeds::Run: return source.result != nullptr;
  }
  return false;
}

pipeline::Exported exportFormats(const ExportSource& source, const ExportWish& wish, const Progress& progress) {
  checkFolder(wish);
  const Making making(wish.folder);
  pipeline::ExportRequest request;
  request.formats = wish.formats;
  request.output = making.path();
  request.caseName = wish.caseName;
  request.reader = wish.reader;
  request.solved = source.result;
  request.leaveOutRefused = true;
  progress.report(0.0, "reading the outlines");
  if (source.result) {
    request.source = source.runFolder;
  } else {
    const fs::path folder = source.folder->path();
    saveFiles(source.record, source.files, folder);
    request.source = folder / "case.json";
  }
  pipeline::Exported done = pipeline::exportFiles(request, progress.part(0.05, 0.95));
  progress.check();
  for (fs::path& file : done.files) {
    const fs::path to = wish.folder / file.lexically_relative(making.path());
    std::error_code failed;
    fs::create_directories(to.parent_path(), failed);
    fs::rename(file, to, failed);
    if (failed)
      throw BadInput("'" + to.filename().string() + "' cannot be put into the folder: " + failed.message() +
                     "; files written before it are there");
    file = to;
  }
  progress.report(1.0, "done");
  return done;
}

}  // namespace glisson::session
