#include "views/vtk_widget.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGenericRenderWindowInteractor.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QSurfaceFormat>
#include <QTimer>
#include <QWheelEvent>
#include <mutex>

#include "render/overlay.h"

namespace glisson::views {

struct VtkWidget::Private {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkGenericRenderWindowInteractor> interactor;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkCallbackCommand> makeCurrent;
  vtkNew<vtkCallbackCommand> isCurrent;
  vtkNew<vtkCallbackCommand> renderAsked;
  bool ready = false;
  bool drawn = false;  ///< there is a frame to show
};

namespace {

constexpr int retry_ms = 60;

bool contextIsCurrent(const QOpenGLWidget& widget) {
  return widget.context() != nullptr && QOpenGLContext::currentContext() == widget.context();
}

void onMakeCurrent(vtkObject*, unsigned long, void* client, void*) {
  auto* widget = static_cast<QOpenGLWidget*>(client);
  // Making a current context current again would bind the widget's framebuffer behind VTK's cached state.
  if (widget->isValid() && !contextIsCurrent(*widget)) widget->makeCurrent();
}

void onIsCurrent(vtkObject*, unsigned long, void* client, void* answer) {
  *static_cast<bool*>(answer) = contextIsCurrent(*static_cast<QOpenGLWidget*>(client));
}

void onRenderAsked(vtkObject*, unsigned long, void* client, void*) {
  static_cast<QOpenGLWidget*>(client)->update();
}

}  // namespace

VtkWidget::VtkWidget(QWidget* parent) : QOpenGLWidget(parent), d_(std::make_unique<Private>()) {
  QSurfaceFormat format;
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setSamples(0);
  setFormat(format);
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);

  d_->window->SetMultiSamples(4);
  d_->window->AddRenderer(d_->renderer);
  d_->makeCurrent->SetClientData(this);
  d_->makeCurrent->SetCallback(onMakeCurrent);
  d_->window->AddObserver(vtkCommand::WindowMakeCurrentEvent, d_->makeCurrent);
  d_->isCurrent->SetClientData(this);
  d_->isCurrent->SetCallback(onIsCurrent);
  d_->window->AddObserver(vtkCommand::WindowIsCurrentEvent, d_->isCurrent);

  // VTK asks to render, Qt decides when: everything is drawn in paintGL.
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  d_->interactor->SetRenderWindow(d_->window);
  d_->interactor->SetInteractorStyle(style);
  d_->interactor->EnableRenderOff();
  d_->renderAsked->SetClientData(this);
  d_->renderAsked->SetCallback(onRenderAsked);
  d_->interactor->AddObserver(vtkCommand::RenderEvent, d_->renderAsked);
  d_->interactor->Initialize();
}

VtkWidget::~VtkWidget() {
  if (context() != nullptr) {
    disconnect(context(), nullptr, this, nullptr);
    makeCurrent();
    releaseGraphics();
    doneCurrent();
  }
  d_->window->RemoveAllObservers();
  d_->interactor->RemoveAllObservers();
}

vtkRenderer* VtkWidget::renderer() const {
  return d_->renderer;
}

void VtkWidget::fitCamera() {
  d_->renderer->ResetCamera();
  d_->renderer->ResetCameraClippingRange();
  update();
}

void VtkWidget::releaseGraphics() {
  if (!d_->ready) return;
  d_->ready = d_->drawn = false;
  d_->window->Finalize();
  d_->window->SetReadyForRendering(false);
}

void VtkWidget::initializeGL() {
  d_->window->SetReadyForRendering(true);
  d_->window->SetOwnContext(0);
  d_->window->OpenGLInitContext();
  d_->ready = true;
  // Moving the widget to another window replaces its context: VTK's objects go with the old one.
  connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, [this] {
    makeCurrent();
    releaseGraphics();
    doneCurrent();
  });
}

void VtkWidget::resizeGL(int, int) {
  const int width = qRound(this->width() * devicePixelRatioF());
  const int height = qRound(this->height() * devicePixelRatioF());
  d_->window->SetDPI(qRound(72.0 * devicePixelRatioF()));
  d_->window->SetSize(width, height);
  d_->interactor->SetSize(width, height);
}

void VtkWidget::paintGL() {
  if (!d_->ready) return;
  vtkOpenGLState* state = d_->window->GetState();
  // Where a picture is being drawn off screen, on another thread, the last frame stays a little longer: waiting for it
  // would stop the window, and drawing text at the same time is not safe.
  const std::unique_lock text(render::textDrawing(), std::try_to_lock);
  if (text) {
    state->Reset();
    state->Push();
    state->vtkglDepthFunc(GL_LEQUAL);
    d_->window->SetFrameBlitModeToNoBlit();
    d_->window->Render();
    state->Pop();
    d_->drawn = true;
  } else {
    QTimer::singleShot(retry_ms, this, qOverload<>(&QWidget::update));
    if (!d_->drawn) return;
    state->Reset();
  }

  const int width = qRound(this->width() * devicePixelRatioF());
  const int height = qRound(this->height() * devicePixelRatioF());
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
  const GLenum attachment = GL_COLOR_ATTACHMENT0;
  context()->extraFunctions()->glDrawBuffers(1, &attachment);
  state->vtkglDisable(GL_SCISSOR_TEST);
  d_->window->BlitDisplayFramebuffer(0, 0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  if (text) emit rendered();
}

bool VtkWidget::event(QEvent* event) {
  auto place = [this](const QPointF& at, Qt::KeyboardModifiers modifiers, int repeat) {
    const double ratio = devicePixelRatioF();
    const int x = qRound(at.x() * ratio);
    const int y = qRound((height() - 1 - at.y()) * ratio);  // VTK counts rows from the bottom
    d_->interactor->SetEventInformation(x, y, modifiers.testFlag(Qt::ControlModifier) ? 1 : 0,
                                        modifiers.testFlag(Qt::ShiftModifier) ? 1 : 0, 0, repeat);
  };
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove: {
      const auto* mouse = static_cast<QMouseEvent*>(event);
      place(mouse->position(), mouse->modifiers(), event->type() == QEvent::MouseButtonDblClick ? 1 : 0);
      if (event->type() == QEvent::MouseMove) {
        d_->interactor->MouseMoveEvent();
        return true;
      }
      const bool press = event->type() != QEvent::MouseButtonRelease;
      if (mouse->button() == Qt::LeftButton)
        press ? d_->interactor->LeftButtonPressEvent() : d_->interactor->LeftButtonReleaseEvent();
      if (mouse->button() == Qt::MiddleButton)
        press ? d_->interactor->MiddleButtonPressEvent() : d_->interactor->MiddleButtonReleaseEvent();
      if (mouse->button() == Qt::RightButton)
        press ? d_->interactor->RightButtonPressEvent() : d_->interactor->RightButtonReleaseEvent();
      return true;
    }
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      place(wheel->position(), wheel->modifiers(), 0);
      if (wheel->angleDelta().y() > 0)
        d_->interactor->MouseWheelForwardEvent();
      else if (wheel->angleDelta().y() < 0)
        d_->interactor->MouseWheelBackwardEvent();
      return true;
    }
    default:
      return QOpenGLWidget::event(event);
  }
}

}  // namespace glisson::views
