// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <QImage>
#include <QTimer>
#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "render/overlay.h"
#include "tools/model_picture.h"
#include "tools/scene_camera.h"
#include "views/marks.h"
#include "views/scene_painter.h"

namespace glisson::views {

class LiveLayer;
class ModelLayer;

/// What a view of a model shows.
struct ModelParts {
  bool surface = true, vessels = true, stiffness = true, sites = false, supports = true, bar = true;
  double most_kPa = 8.0;  ///< end of the colour scale
  bool operator==(const ModelParts&) const = default;
};

/// A 3-D view: the overlay of one retraction, the same drawing as the exported picture, or the model before a run.
/// Left drag turns, middle drag or Shift+left drag moves, right drag or wheel zooms, a double click shows all. Keys:
/// arrows turn, with Shift they move; + and - zoom, Home shows all; Space chooses the next mark, Ctrl+arrows move it
/// (or the live tool) by 1 mm, with Shift by 10 mm; Enter places in the middle. The pictures are made by a painter's
/// own thread; this widget shows the latest and draws marks over it.
class SceneView : public QWidget {
  Q_OBJECT
 public:
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;

  void setScene(std::shared_ptr<const render::RetractionScene> scene);
  void setModel(std::shared_ptr<const tools::ModelPicture> model);  ///< keeps the camera while models follow each other
  void clear();
  bool hasScene() const { return scene_ != nullptr; }
  /// Whether the picture shows all that was asked for.
  bool isSettled() const;
  bool hasModel() const { return model_ != nullptr; }
  /// Fraction of the displacement that is shown: 0 at rest, 1 retracted. Keeps the camera.
  void setFraction(double t);
  void setPalette3D(render::Palette palette);
  /// Of Shown3D::HowSure.
  void setLanguage(Language language) { options_.language = language; }
  /// Both answers, the contact pressure on one, seen from where the bar touches, or how sure the vessels are. Pressure
  /// needs a scene with a bar, HowSure one with a spread of its vessels.
  void setShown(render::Shown3D shown);
  void setArrows(bool on);  ///< displacement of both answers, true to scale
  void setView(render::View3D view);
  void setHint(const QString& hint);
  void setParts(const ModelParts& parts);
  const ModelParts& parts() const { return parts_; }
  /// Words in a corner, over the picture.
  void setCaption(const QString& caption);
  void setOutdated(const QString& words);  ///< as PictureView::setOutdated

  /// Drawn over the picture; the mouse chooses and moves them.
  void setMarks(std::vector<Mark> marks);
  const std::vector<Mark>& marks() const { return marks_; }
  /// The next left click on the liver tells its place instead of turning.
  void setPlacing(bool on);
  bool placing() const { return placing_; }

  /// Live: the liver at rest and what moveLive says, instead of the run's own answer. Needs a scene; a new scene ends
  /// it.
  void setLive(bool live);
  bool isLive() const { return layer_ != nullptr; }
  /// As LiveLayer::move; drawn with the next frame.
  void moveLive(const Eigen::Matrix3Xd& mre_mm, const Eigen::Matrix3Xd& atlas_mm, const Eigen::Vector3d& tool_mm,
                const Eigen::Vector3d& atlasTool_mm);
  /// Where the tool's contact is seen, in logical pixels of this view; nothing while not live.
  std::optional<QPointF> toolPixel() const;

  const tools::SceneCamera& camera() const { return camera_; }
  QPointF pixelOf(const Eigen::Vector3d& p_lps) const;
  /// The picture on screen, null before the first.
  const QImage& picture() const { return image_; }

 signals:
  void rendered();  ///< a frame came from the painter
  void toolDragged(
      const Eigen::Vector3d& displacement_mm);  ///< of the contact from rest, LPS, in the plane of the view
  void markChosen(int id);
  void markMoved(int id, const Eigen::Vector3d& p_lps, bool ended);
  void surfaceClicked(const Eigen::Vector3d& p_lps);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  enum class Drag { None, Turn, Pan, Zoom, Tool, Mark };
  Eigen::Vector2d size_px() const;
  bool hasPicture() const { return scene_ || model_; }
  const anatomy::TriangleMesh* surface() const;  ///< that marks lie on
  std::optional<Eigen::Vector3d> surfaceUnder(const QPointF& at,
                                              const std::optional<Eigen::Vector3d>& against = std::nullopt) const;
  void startAnew();
  void compose(bool keepCamera);
  void composeModel();
  void fitModel();
  void showAll();
  void chooseNext();
  void moveChosen(const Eigen::Vector2d& by_mm);
  void draw(bool hurried);
  void moved();  ///< the camera
  void take(const ScenePainter::Frame& frame);
  void paintModelLegend(QPainter& painter) const;
  void paintAxes(QPainter& painter) const;

  std::shared_ptr<const render::RetractionScene> scene_;
  std::shared_ptr<const tools::ModelPicture> model_;
  render::SceneOptions3D options_;
  ModelParts parts_;
  std::vector<Mark> marks_;
  bool placing_ = false;
  ScenePainter painter_;
  std::shared_ptr<std::unique_ptr<LiveLayer>> layer_;        ///< null while not live; the painter's thread looks inside
  std::shared_ptr<std::unique_ptr<ModelLayer>> modelLayer_;  ///< likewise
  QImage image_;
  tools::SceneCamera camera_;             ///< wanted
  tools::SceneCamera shownCamera_;        ///< of the picture on screen
  std::uint64_t wished_ = 0, drawn_ = 0;  ///< numbers of pictures
  std::uint64_t since_ = 0;               ///< later pictures show what is shown now
  bool cameraKnown_ = false;              ///< else the painter's own is taken with the next frame
  QTimer settle_;                         ///< a fine picture once nothing moves
  Drag drag_ = Drag::None;
  QPointF pressed_, last_;
  bool dragged_ = false;
  Eigen::Vector3d toolMoved_mm_ = Eigen::Vector3d::Zero(), gripMoved_mm_ = Eigen::Vector3d::Zero();
  int heldMark_ = 0;
  QString hint_, caption_, outdated_;
};

}  // namespace glisson::views
