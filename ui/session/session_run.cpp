// SPDX-License-Identifier: GPL-3.0-or-later

// Running: the case is saved into the work folder, then run from there by what the command line uses for a case too.
#include "base/error.h"
#include "pipeline/result_file.h"
#include "session/export_formats.h"
#include "session/export_results.h"
#include "session/session.h"

namespace glisson::session {

void Session::run() {
  if (stillAtWork()) return;
  if (acceptedCount() == 0) {
    emit message(tr("Outline the liver and accept the outline (Enter) first."));
    return;
  }
  failure_[static_cast<std::size_t>(Step::Retract)].clear();
  failure_[static_cast<std::size_t>(Step::Compare)].clear();
  const std::filesystem::path folder = workFolder().toStdString();
  work_ = Work::Run;
  auto result = std::make_shared<pipeline::RunResult>();
  tellDrafts();
  worker_.start(
      [folder, result, record = caseRecord(folder), files = caseFiles(folder)](const Progress& progress) {
        saveFiles(record, files, folder);
        pipeline::RunOptions options;
        options.output = folder / "results";
        *result = pipeline::run(pipeline::readScene(folder / "case.json"), options, progress);
        // Kept with the case when that is saved; the picture has a file of its own.
        std::optional<render::RetractionScene> picture = std::move(result->picture);
        result->picture.reset();
        pipeline::writeResultFile(options.output, *result);
        result->picture = std::move(picture);
      },
      [this, result, outlines = outlinesRevision_, parameters = parameters_](std::exception_ptr failure) {
        if (!failure) {
          // The overlays are drawn from a copy of their own, so that nothing is held twice.
          picture_ =
              result->picture ? std::make_shared<const render::RetractionScene>(std::move(*result->picture)) : nullptr;
          result->picture.reset();
          result_ = result;
          resultOutlines_ = outlines;
          resultParameters_ = parameters;
          resultWasStale_ = false;
        }
        ended(Work::Run, failure);
        if (!failure) emit runFinished();
      });
  emit workStarted(tr("Running"));
  emit statusChanged();
}

// An outline that does not count is not lost from the region unseen.
void Session::tellDrafts() {
  const OutlineCoverage c = coverage();
  if (c.drafts.empty()) return;
  QStringList slices;
  for (const int k : c.drafts) slices << QString::number(k + 1);
  emit message(tr("Drafts do not count (slices %1): accept or delete them before the numbers are used.")
                   .arg(slices.join(QStringLiteral(", "))));
}

void Session::exportInto(const QString& folder, render::Palette palette) {
  if (!result_ || !picture_ || stillAtWork()) return;
  work_ = Work::Export;
  auto files = std::make_shared<int>(0);
  worker_.start(
      [files, result = result_, picture = picture_, palette, from = std::filesystem::path(runFolder().toStdString()),
       target = std::filesystem::path(folder.toStdString())](const Progress& progress) {
        *files = static_cast<int>(exportResults(*result, *picture, palette, from, target, progress).size());
      },
      [this, files](std::exception_ptr failure) {
        ended(Work::Export, failure);
        emit exported(*files, wasCancelled(failure) ? tr("cancelled") : reasonOf(failure));
      });
  emit workStarted(tr("Exporting"));
  emit statusChanged();
}

ExportSource Session::exportSource() const {
  ExportSource source;
  source.folder = std::make_shared<const PrivateFolder>();
  source.record = caseRecord(source.folder->path());
  source.files = caseFiles(source.folder->path());
  source.outlines = acceptedCount() > 0;
  if (result_ && !resultIsStale()) {
    source.result = result_;
    source.runFolder = runFolder().toStdString();
  }
  return source;
}

void Session::exportVideo(const QString& file, const VideoWish& wish) {
  if (!picture_ || stillAtWork()) return;
  work_ = Work::Export;
  worker_.start([picture = picture_, wish, target = std::filesystem::path(file.toStdString())](
                    const Progress& progress) { writeRetractionVideo(target, *picture, wish, progress); },
                [this](std::exception_ptr failure) {
                  ended(Work::Export, failure);
                  emit exported(failure ? 0 : 1, wasCancelled(failure) ? tr("cancelled") : reasonOf(failure));
                });
  emit workStarted(tr("Filming"));
  emit statusChanged();
}

}  // namespace glisson::session
