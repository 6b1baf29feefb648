// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <QObject>
#include <QString>
#include <QTimer>
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "commands/undo_stack.h"
#include "dicom/series.h"
#include "elastography/statistics.h"
#include "elastography/stiffness_map.h"
#include "image/volume.h"
#include "pipeline/run.h"
#include "pipeline/scene.h"
#include "pipeline/sources.h"
#include "roi/contour_stack.h"
#include "session/case_file.h"
#include "session/case_lock.h"
#include "session/interpolated_slices.h"
#include "session/journal.h"
#include "session/offered_regions.h"
#include "session/parameters.h"
#include "session/retraction_video.h"
#include "session/step.h"
#include "session/work_folder.h"
#include "session/worker.h"
#include "tools/polygon_tool.h"

namespace glisson::session {

class ModelPreview;
struct ExportSource;

/// What stands between the MRI and its elastogram.
struct Question {
  enum class Kind {
    None,      ///< nothing to be answered: it cannot be used
    Together,  ///< of another patient, day or frame of reference: Session::useTogether
    Meaning    ///< without quantity and unit: Session::setMeaning
  } kind;
  QString text;
};

/// The volumes that are shown and measured, with the series they came from (indices into the scan).
struct OpenImages {
  std::shared_ptr<const image::ScalarVolume> mri;
  std::shared_ptr<const elastography::StiffnessMap> stiffness;
  std::shared_ptr<const image::ScalarVolume> magnitude;          ///< null where there is none beside the MRI
  std::vector<std::shared_ptr<const image::ScalarVolume>> wave;  ///< time steps, in order, on one grid
  int mriSeries = -1, stiffnessSeries = -1, confidenceSeries = -1;
  Choices choices;  ///< with roles set by hand both sources are the folder that was opened
  /// Folders in which the command line finds these very series by its own rule for roles; empty where there is none.
  std::filesystem::path mriSource, mreSource;
  QString note;                      ///< what could not be read, and why
  std::optional<Question> question;  ///< why the elastogram is left out; empty where it is not
};

/// What no case file holds yet.
struct Unsaved {
  bool outlines = false;  ///< with marks and names
  bool settings = false;  ///< roles, answers, parameters, bar, hoist and holds
  bool any() const { return outlines || settings; }
};

/// What could not be opened, and why.
struct Refusal {
  QString what;    ///< name of the file or folder, without its place
  QString reason;  ///< a sentence
};

/// What is no longer as it was when the last run began.
struct ChangedSince {
  bool outlines = false;    ///< with images, roles and marks of slices
  bool parameters = false;  ///< of Model and Retract, with what was laid by hand
  bool before = false;      ///< something, before the case was opened
  bool any() const { return outlines || parameters || before; }
};

/// Stiffness under the contours, outline in work included.
struct LiveStatistics {
  std::shared_ptr<const image::Mask> region;        ///< what counts, on the MRI grid, with empty slices filled by shape
  double volume_mL = 0.0;                           ///< of that
  std::optional<elastography::Statistics> slice;    ///< of the elastogram's slice nearest to the one shown now
  std::optional<elastography::Measurement> pooled;  ///< of all slices
  bool rimKept = false;                             ///< no inner region is left of so small an outline: measured whole
  QString reason;                                   ///< why there are none
};

/// A case as it is written: everything by value, so that a worker can write it while the window goes on.
struct CaseFiles {
  OpenImages images;
  commands::Outlines contours;
  pipeline::Scene scene;
  std::shared_ptr<const image::Mask> vessels;  ///< that are not measured; null: none, or they are measured
};
/// Writes the case into the folder (and mri.nrrd, where no folder names the series), for this window and for
/// `glisson-cli run case.json`. Returns its version. Throws BadInput.
int saveFiles(CaseRecord record, const CaseFiles& files, const std::filesystem::path& folder);

/// Chooses the series by their roles and reads them. guessed: the scan before any role was corrected by hand. root: the
/// folder that was opened. A missing elastogram is told in note, one that may not be used in question; a missing MRI is
/// a BadInput.
OpenImages readImages(const dicom::ScanResult& scan, const dicom::ScanResult& guessed,
                      const std::filesystem::path& root, const Choices& choices, const Progress& progress);

/// The one observable model of what is open. Owned and called by one thread; all work over a few milliseconds is done
/// by workers, whose results arrive as signals.
class Session : public QObject {
  Q_OBJECT
 public:
  explicit Session(QObject* parent = nullptr);
  ~Session() override;

  // Load
  void openPath(const QString& path);  ///< a folder, DICOMDIR, archive, volume file or case
  /// Several at once: volumes, masks, maps and folders that belong together. A region that was named is taken as
  /// outlines, where it is the only one. One path: as openPath.
  void openPaths(const QStringList& paths);
  /// Why the last opening was refused; empty once something was opened. What was open before stays.
  const std::optional<Refusal>& refusal() const { return refusal_; }
  /// Regions beside the images that could be taken as outlines.
  const std::vector<OfferedRegion>& regions() const { return regions_; }
  /// Makes a synthetic patient, written as DICOM below folder (empty: the cache), and opens it like any other.
  void openSynthetic(std::uint64_t seed = 1, const QString& folder = {});
  const dicom::ScanResult& scan() const { return scan_; }
  const QString& path() const { return path_; }
  const OpenImages& images() const { return images_; }
  /// Corrects what a series is for, and makes it the one in use of its role; the images are read again, outlines stay.
  /// index: of scan().series.
  void setRole(int index, dicom::SeriesRole role);
  bool inUse(int index) const;  ///< of scan().series: shown or measured
  /// Answers to images().question; kept in the case, and the command line takes them from there. no: the elastogram
  /// stays left out. setMeaning throws BadInput for a unit that is none.
  void useTogether(bool yes);
  void setMeaning(StiffnessQuantity quantity, const QString& unit);

  // Segment
  const commands::Outlines& contours() const { return contours_; }
  tools::PolygonTool& tool() { return tool_; }
  void apply(const tools::Acts& acts);  ///< what a gesture asks, each act one undo step
  void toolMoved();                     ///< the tool's picture changed, contours did not
  void undo();
  void redo();
  bool canUndo() const;
  bool canRedo() const;
  QString undoText() const;
  QString redoText() const;
  /// Reads an RT Structure Set, contour file or mask as contours in place of those that are there, one undo step.
  /// confirm: asked where they have another frame of reference; told by message where nobody can be asked. Throws
  /// BadInput, also where they belong to another patient or day.
  void importContours(const QString& file, const std::function<bool(const QString&)>& confirm = {});
  void importRegion(const OfferedRegion& region, const std::function<bool(const QString&)>& confirm = {});
  void park();                                         ///< what is being drawn becomes a draft of its slice
  void setShownPlane(const tools::SlicePlane& plane);  ///< of the MRI: where live statistics look
  const LiveStatistics& statistics() const { return statistics_; }
  std::size_t acceptedCount() const;
  /// Fills empty slices between drawn ones by shape (roi/interpolate.h), in place of what was interpolated before: one
  /// undo step, done by a worker. Interpolated outlines count at once.
  void interpolateOutlines();
  void acceptInterpolated();  ///< all of them, one undo step
  OutlineCoverage coverage() const;
  /// Proposes outlines: a region grown from the point by a worker, on every slice that has none; one undo step. They
  /// look like interpolated ones until they are accepted.
  void propose(const Eigen::Vector3d& seed_lps);
  /// Marks the slice shown, or takes the same mark away; refused with a message where it contradicts the outlines.
  void toggleMark(commands::SliceMark mark);
  std::optional<commands::SliceMark> markOf(int slice) const;
  /// The next slice after this one, around the end, that has neither an accepted outline nor a mark.
  std::optional<int> nextPending(int after) const;
  void rename(const QString& name);   ///< of the region; one undo step
  void copyOutlines();                ///< the selected outline, or all of the slice shown
  void pasteOutlines();               ///< on the slice shown, as drafts
  void pasteBetween();                ///< on the empty slices from where they were copied to the slice shown
  void pasteTo(int first, int last);  ///< on these slices (k), where they are empty
  bool canPaste() const { return !clipboard_.empty(); }
  const MeasureSettings& measureSettings() const { return measure_; }
  void setMeasureSettings(const MeasureSettings& settings);
  /// Border of the inner region on the elastogram, null where it is off or empty.
  const std::shared_ptr<const image::Mask>& innerMask() const { return inner_; }
  /// Vessels found in the MRI inside the region, on the grid of the elastogram; null while they are not known.
  const std::shared_ptr<const image::Mask>& vesselMask() const { return vessels_; }
  /// A second reader's outlines, shown beside the first's and compared with them; empty path: none. Throws BadInput.
  void loadSecondReader(const QString& file);
  const roi::ContourStack& secondReader() const { return second_; }
  void compareReaders();  ///< by a worker; readersCompared tells how both agree, in words

  // Model, Retract, Compare
  const Parameters& parameters() const { return parameters_; }
  void setParameters(const Parameters& parameters);
  /// What was laid by hand, one step of an undo of its own: that of the outlines is not touched. what: for the menu.
  void place(const Placement& placement, double barLength_mm, const QString& what);
  void undoPlacement();
  void redoPlacement();
  bool canUndoPlacement() const { return placingsDone_ > 0; }
  bool canRedoPlacement() const { return placingsDone_ < placings_.size(); }
  QString undoPlacementText() const { return canUndoPlacement() ? placings_[placingsDone_ - 1].what : QString(); }
  QString redoPlacementText() const { return canRedoPlacement() ? placings_[placingsDone_].what : QString(); }
  ModelPreview& preview();                              ///< the model as it would be run now
  std::uint64_t revision() const { return revision_; }  ///< grows with everything that a run depends on
  /// The case by value, as it would be written into the folder now.
  CaseFiles caseFiles(const std::filesystem::path& folder) const;
  /// What would run now; paths are those of saveCase(folder).
  pipeline::Scene scene(const std::filesystem::path& folder) const;
  void run();  ///< saves the case into the work folder and does what the command line would do with it
  void cancel();
  bool busy() const { return worker_.busy(); }
  std::shared_ptr<const pipeline::RunResult> result() const { return result_; }
  std::shared_ptr<const render::RetractionScene> picture() const { return picture_; }
  ChangedSince changedSinceRun() const;  ///< nothing where there is no run
  bool resultIsStale() const { return changedSinceRun().any(); }
  QString runFolder() const;
  /// Pictures, report and record of the last run (export_results.h) into the folder, by a worker; ends with exported.
  void exportInto(const QString& folder, render::Palette palette);
  /// What export_formats.h writes: the case as it is now, with its run where that is of what is shown. Throws BadInput.
  ExportSource exportSource() const;
  /// A film of the last run (retraction_video.h), by a worker; ends with exported.
  void exportVideo(const QString& file, const VideoWish& wish);

  // Case
  /// Writes case.json, contours.json and scene.json so that `glisson-cli run case.json` gives the same numbers.
  /// Throws BadInput; the outlines are kept.
  void saveCase(const QString& folder);
  void saveInBackground();                                   ///< into the folder the case is from
  const QString& caseFolder() const { return caseFolder_; }  ///< empty while it was never saved
  bool readOnly() const { return lock_ && !lock_->writable(); }
  void setJournalFolder(const QString& folder) { journalFolder_ = folder; }
  const QString& journalFolder() const { return journalFolder_; }
  /// Opens what a journal belongs to, and puts its outlines back; the journal goes once that is done.
  void recover(const Journalled& journalled);
  void setWorkFolder(const QString& folder);  ///< where runs write; default: a WorkFolder of the cache
  static QString cacheFolder();               ///< of all windows

  StepStatus status(Step step) const;
  bool modified() const { return unsaved_.any(); }
  const Unsaved& unsaved() const { return unsaved_; }

 signals:
  void loaded();  ///< scan and images are new
  void asked();   ///< images().question has not been answered yet
  void contoursChanged();
  void toolChanged();                              ///< what the tool shows changed
  void pointWanted(const Eigen::Vector3d& p_lps);  ///< show the slice of this point
  void statisticsChanged();
  void parametersChanged();
  void statusChanged();
  void progressed(double fraction, const QString& what, double secondsLeft);
  void workStarted(const QString& what);
  void workEnded(bool well, const QString& reason);  ///< reason: empty when well or cancelled
  void runFinished();
  void message(const QString& text);
  void readersCompared(const QString& text);
  void exported(int files, const QString& reason);  ///< reason: empty where it went well
  void saved(int version);
  void saveFailed(const QString& reason);

 private:
  enum class Work { None, Load, Run, Interpolate, Readers, Propose, Export };
  /// What is to be opened, found out by the worker.
  struct Wanted {
    std::filesystem::path path;
    std::optional<CaseRecord> record;
    std::filesystem::path caseFolder;
    std::shared_ptr<CaseLock> lock;
    std::optional<Journalled> journalled;
    std::vector<std::string> files;  ///< Choices::files, where nothing else holds them
  };
  struct Opened;
  void startLoad(std::function<Wanted(const Progress&)> prepare, const QString& what, const QString& name);
  static void openInto(Opened& opened, const std::filesystem::path& work, const Progress& progress);
  void loadEnded(Opened& opened, const QString& name, std::exception_ptr failure);
  void takeOnlyRegion(const pipeline::LoadedRoi& region);
  bool takeOutlines(const pipeline::LoadedRoi& roi, const std::function<bool(const QString&)>& confirm);
  void keepLastRun(const std::filesystem::path& folder);
  static Wanted wantedCase(const std::filesystem::path& path);
  void take(Opened& opened);
  void drawnOn();
  void tellImages();
  void lockAgain();
  bool stillAtWork();
  void readAgain(const Choices& choices);
  Settings settings() const { return {images_.choices, parameters_, measure_}; }
  void settingsTouched();
  const QString& workFolder() const;
  CaseRecord caseRecord(const std::filesystem::path& folder) const;
  void journal();
  void beginJournal();
  Eigen::Vector3d middleOf(int slice) const;
  void paste(const std::vector<int>& slices, roi::PolygonState state, const char* text);
  void ended(Work work, std::exception_ptr failure);
  void measure();
  commands::Outlines countedNow() const;
  void contoursTouched();
  void replaceContours(roi::ContourStack after, const char* text);
  void noteMade(const roi::ContourStack& after, commands::MadeBy by);
  void measureSoon();
  void pickSlice();
  std::optional<int> mapSliceShown() const;
  void measureRegion();
  void findVessels();
  void tellDrafts();
  mutable std::unique_ptr<WorkFolder> ownFolder_;  ///< goes after the workers
  Worker worker_;
  Worker measurer_;  ///< of the live readout; only the latest outlines count
  Worker regioner_;  ///< of the region and its volume, once the hand rests
  Worker vesseler_;  ///< of the vessels in it, once it is left alone
  bool measureAgain_ = false;
  Work work_ = Work::None;
  QString path_;
  dicom::ScanResult scan_, guessed_;
  OpenImages images_;
  std::vector<OfferedRegion> regions_;
  std::optional<Refusal> refusal_;
  commands::Outlines contours_;
  roi::ContourStack second_;
  std::vector<roi::Polygon> clipboard_;
  MeasureSettings measure_;
  std::shared_ptr<const image::Mask> inner_;
  std::shared_ptr<const image::Mask> vessels_, vesselsOf_;  ///< on the map, and the region that they were found in
  commands::UndoStack undo_;
  tools::PolygonTool tool_;
  std::optional<tools::SlicePlane> plane_;
  LiveStatistics statistics_;
  struct RegionKey {
    std::uint64_t revision = 0;
    tools::ToolState state{};
    std::optional<std::size_t> selected;
    bool operator==(const RegionKey&) const = default;
  };
  std::optional<RegionKey> measuredKey_;  ///< what statistics_.pooled was made of; empty: of an outline in work
  std::optional<RegionKey> regionKey_;    ///< what statistics_.region was made of
  QTimer measureTimer_, regionTimer_, vesselTimer_;
  Parameters parameters_;
  struct Placed {
    Placement placement;
    double barLength_mm = 0.0;
    bool operator==(const Placed&) const = default;
  };
  struct Placing {
    Placed before, after;
    QString what;
  };
  void take(const Placed& placed);
  void forgetPlacings();
  std::vector<Placing> placings_;
  std::size_t placingsDone_ = 0;
  ModelPreview* preview_ = nullptr;  ///< a child; made when first asked for
  mutable QString workFolder_;       ///< empty until it is needed
  QString caseFolder_, journalFolder_;
  std::shared_ptr<CaseLock> lock_;
  std::unique_ptr<Journal> journal_;
  Eigen::Index journalledVertices_ = 0;  ///< of the outline in work
  bool journalFailed_ = false;           ///< told once
  QTimer journalTimer_;                  ///< of parameters, which come in quick succession
  std::filesystem::path recovered_;      ///< journal that goes once the new one holds what it held
  Worker saver_;
  QTimer autosave_;
  std::shared_ptr<const pipeline::RunResult> result_;
  std::shared_ptr<const render::RetractionScene> picture_;
  struct {
    QString folder;
    std::weak_ptr<const pipeline::RunResult> result;
  } lastKept_;                                               ///< run and case folder that hold each other already
  std::uint64_t revision_ = 0;                               ///< of everything a run depends on
  std::uint64_t outlinesRevision_ = 0, resultOutlines_ = 0;  ///< of outlines and images: now, and of the last run
  Parameters resultParameters_;                              ///< of the last run
  bool resultWasStale_ = false;                              ///< already when its case was opened
  Unsaved unsaved_;
  std::array<QString, 5> failure_;  ///< per step, empty where none
};

}  // namespace glisson::session
