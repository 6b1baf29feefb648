#pragma once

#include <QOpenGLWidget>
#include <memory>

class vtkRenderer;

namespace glisson::views {

/// The one bridge between Qt 6 and VTK: a QOpenGLWidget that shows a vtkGenericOpenGLRenderWindow. Mouse and wheel
/// turn, move and zoom the camera (trackball).
class VtkWidget : public QOpenGLWidget {
  Q_OBJECT
 public:
  explicit VtkWidget(QWidget* parent = nullptr);
  ~VtkWidget() override;

  /// The renderer that fills the widget. Change it, then call update().
  vtkRenderer* renderer() const;
  /// Puts the camera so that all that is visible fits, seen from where it is seen now.
  void fitCamera();

 signals:
  /// After each frame that was drawn.
  void rendered();

 protected:
  void initializeGL() override;
  void resizeGL(int width, int height) override;
  void paintGL() override;
  bool event(QEvent* event) override;

 private:
  void releaseGraphics();
  struct Private;
  std::unique_ptr<Private> d_;
};

}  // namespace glisson::views
