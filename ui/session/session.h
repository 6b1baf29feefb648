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
#include "roi/contour_stack.h"
#include "session/interpolated_slices.h"
#include "session/parameters.h"
#include "session/step.h"
#include "session/worker.h"
#include "tools/polygon_tool.h"

namespace glisson::session {

/// The volumes that are shown and measured, with the series they came from (indices into the scan).
struct OpenImages {
  std::shared_ptr<const image::ScalarVolume> mri;
  std::shared_ptr<const elastography::StiffnessMap> stiffness;
  int mriSeries = -1, stiffnessSeries = -1, confidenceSeries = -1;
  /// Folders in which the command line finds these very series by its own rule for roles; empty where there is none.
  std::filesystem::path mriSource, mreSource;
  QString note;  ///< what could not be read, and why
};

/// Stiffness under the contours, outline in work included.
struct LiveStatistics {
  std::optional<elastography::Statistics> slice;    ///< of the elastogram's slice nearest to the one shown
  std::optional<elastography::Measurement> pooled;  ///< of all slices
  QString reason;                                   ///< why there are none
};

/// A case as it is written: everything by value, so that a worker can write it while the window goes on.
struct CaseFiles {
  OpenImages images;
  roi::ContourStack contours;
  pipeline::Scene scene;
};
/// Writes contours.json and scene.json (and mri.nrrd, where no folder names the series) into the folder. Throws
/// BadInput.
void writeCase(CaseFiles files, const std::filesystem::path& folder);

/// Chooses the series by their roles and reads them. guessed: the scan before any role was corrected by hand. root: the
/// folder that was opened. A missing elastogram is told in note; a missing MRI is a BadInput.
OpenImages readImages(const dicom::ScanResult& scan, const dicom::ScanResult& guessed,
                      const std::filesystem::path& root, const Progress& progress);

/// The one observable model of what is open. Owned and called by one thread; all work over a few milliseconds is done
/// by workers, whose results arrive as signals.
class Session : public QObject {
  Q_OBJECT
 public:
  explicit Session(QObject* parent = nullptr);
  ~Session() override;

  // Load
  void openPath(const QString& path);  ///< a folder or file of DICOM
  /// Makes a synthetic patient, written as DICOM below folder (empty: the cache), and opens it like any other.
  void openSynthetic(std::uint64_t seed = 1, const QString& folder = {});
  const dicom::ScanResult& scan() const { return scan_; }
  const QString& path() const { return path_; }
  const OpenImages& images() const { return images_; }
  /// Corrects what a series is for; the images are read again. index: of scan().series.
  void setRole(int index, dicom::SeriesRole role);

  // Segment
  const roi::ContourStack& contours() const { return contours_; }
  tools::PolygonTool& tool() { return tool_; }
  void apply(const tools::Acts& acts);  ///< what a gesture asks, each act one undo step
  void toolMoved();                     ///< the tool's picture changed, contours did not
  void undo();
  void redo();
  bool canUndo() const;
  bool canRedo() const;
  QString undoText() const;
  QString redoText() const;
  /// Reads an RT Structure Set, contour file or mask as contours, one undo step. Throws BadInput.
  void importContours(const QString& file);
  void setShownPlane(const tools::SlicePlane& plane);  ///< of the MRI: where live statistics look
  const LiveStatistics& statistics() const { return statistics_; }
  std::size_t acceptedCount() const;
  /// Fills empty slices between drawn ones by shape (roi/interpolate.h), in place of what was interpolated before: one
  /// undo step, done by a worker. Interpolated outlines count at once.
  void interpolateOutlines();
  void acceptInterpolated();  ///< all of them, one undo step
  OutlineCoverage coverage() const;

  // Model, Retract, Compare
  const Parameters& parameters() const { return parameters_; }
  void setParameters(const Parameters& parameters);
  /// What would run now; paths are those of saveCase(folder).
  pipeline::Scene scene(const std::filesystem::path& folder) const;
  void run();  ///< saves the case into the work folder and does what the command line would do with it
  void cancel();
  bool busy() const { return worker_.busy(); }
  std::shared_ptr<const pipeline::RunResult> result() const { return result_; }
  std::shared_ptr<const render::RetractionScene> picture() const { return picture_; }
  bool resultIsStale() const;
  QString runFolder() const;

  // Case
  /// Writes contours.json and scene.json so that `glisson-cli run scene.json` gives the same numbers. Throws BadInput.
  void saveCase(const QString& folder);
  void setWorkFolder(const QString& folder);  ///< where runs write; default: a folder of the cache

  StepStatus status(Step step) const;
  bool modified() const { return modified_; }

 signals:
  void loaded();  ///< scan and images are new
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

 private:
  enum class Work { None, Load, Run, Interpolate };
  void startLoad(std::function<std::filesystem::path(const Progress&)> prepare, const QString& what);
  CaseFiles caseFiles(const std::filesystem::path& folder) const;
  void ended(Work work, std::exception_ptr failure);
  void measure();
  void contoursTouched();
  void replaceContours(roi::ContourStack after, const char* text);
  Worker worker_;
  Worker measurer_;  ///< of the live readout; only the latest outlines count
  bool measureAgain_ = false;
  Work work_ = Work::None;
  QString path_;
  dicom::ScanResult scan_, guessed_;
  OpenImages images_;
  roi::ContourStack contours_;
  commands::UndoStack undo_;
  tools::PolygonTool tool_;
  std::optional<tools::SlicePlane> plane_;
  LiveStatistics statistics_;
  QTimer measureTimer_;
  Parameters parameters_;
  QString workFolder_;
  std::shared_ptr<const pipeline::RunResult> result_;
  std::shared_ptr<const render::RetractionScene> picture_;
  std::uint64_t revision_ = 0, resultRevision_ = 0;  ///< of everything a run depends on
  bool modified_ = false;
  std::array<QString, 5> failure_;  ///< per step, empty where none
};

}  // namespace glisson::session
