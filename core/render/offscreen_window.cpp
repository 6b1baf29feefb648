// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/offscreen_window.h"

#include <vtk_glew.h>
// GLEW comes before any other OpenGL header.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.h"

namespace glisson::render {
namespace {

/// A desktop OpenGL 3.2 core context and a small pbuffer to make it current on.
class EglContext {
 public:
  EglContext(EGLenum platform, const char* name) {
    const auto getDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!getDisplay) fail(name, "the EGL library knows no platforms");
    display_ = getDisplay(platform, EGL_DEFAULT_DISPLAY, nullptr);
    EGLint major = 0, minor = 0;
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, &major, &minor)) fail(name, "no EGL display");
    if (!eglBindAPI(EGL_OPENGL_API)) fail(name, "no desktop OpenGL");
    constexpr EGLint wanted[] = {EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT,
                                 EGL_RED_SIZE,
                                 8,
                                 EGL_GREEN_SIZE,
                                 8,
                                 EGL_BLUE_SIZE,
                                 8,
                                 EGL_DEPTH_SIZE,
                                 24,
                                 EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, wanted, &config, 1, &count) || count < 1) fail(name, "no usable pixel format");
    constexpr EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) fail(name, "no OpenGL 3.2 core context");
    constexpr EGLint size[] = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
    surface_ = eglCreatePbufferSurface(display_, config, size);
    if (surface_ == EGL_NO_SURFACE || !eglMakeCurrent(display_, surface_, surface_, context_))
      fail(name, "the context cannot be made current");
  }
  ~EglContext() { release(); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void makeCurrent() { eglMakeCurrent(display_, surface_, surface_, context_); }
  bool isCurrent() const { return eglGetCurrentContext() == context_; }

 private:
  [[noreturn]] void fail(const char* name, const char* why) {
    release();
    throw RenderUnavailable(std::string(name) + ": " + why);
  }
  /// The display itself stays: it is shared by all contexts of the process.
  void release() {
    if (display_ == EGL_NO_DISPLAY) return;
    if (context_ != EGL_NO_CONTEXT && isCurrent())
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    surface_ = EGL_NO_SURFACE;
    context_ = EGL_NO_CONTEXT;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

/// VTK's generic window on an EGL context. GLEW is built for GLX and says "no GLX display" although it has loaded every
/// entry point: that one code counts as success here.
class EglRenderWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglRenderWindow* New();
  vtkTypeMacro(EglRenderWindow, vtkGenericOpenGLRenderWindow);

  EglContext* egl = nullptr;

  void MakeCurrent() override {
    if (egl) egl->makeCurrent();
  }
  bool IsCurrent() override { return egl && egl->isCurrent(); }
  void OpenGLInitContext() override {
    if (Initialized) return;
    glewExperimental = GL_TRUE;
    const GLenum result = glewInit();
    constexpr GLenum noGlxDisplay = 4;  // GLEW_ERROR_NO_GLX_DISPLAY
    GlewInitValid = result == GLEW_OK || result == noGlxDisplay;
    if (!GlewInitValid || !glGenVertexArrays)
      throw RenderUnavailable("the OpenGL entry points cannot be loaded (GLEW code " + std::to_string(result) + ")");
    Initialized = true;
  }
};
vtkStandardNewMacro(EglRenderWindow);

std::unique_ptr<EglContext> makeContext(RenderBackend backend) {
  std::string tried;
  if (backend != RenderBackend::X11) {
    try {
      return std::make_unique<EglContext>(EGL_PLATFORM_SURFACELESS_MESA, "EGL without a display");
    } catch (const RenderUnavailable& e) {
      tried = e.what();
    }
  }
  const char* display = std::getenv("DISPLAY");
  if (backend != RenderBackend::Egl && display && *display) {
    try {
      return std::make_unique<EglContext>(EGL_PLATFORM_X11_KHR, "EGL on the X server");
    } catch (const RenderUnavailable& e) {
      tried += (tried.empty() ? "" : "; ") + std::string(e.what());
    }
  } else if (backend != RenderBackend::Egl) {
    tried += (tried.empty() ? "" : "; ") + std::string("X11: DISPLAY is not set");
  }
  throw RenderUnavailable("3-D pictures cannot be drawn (" + tried +
                          "). Install libegl1 and libgl1-mesa-dri, or set DISPLAY to a running X server");
}

void noteError(vtkObject*, unsigned long, void* client, void* data) {
  auto& errors = *static_cast<std::string*>(client);
  if (errors.empty() && data) errors = static_cast<const char*>(data);
}

}  // namespace

struct OffscreenWindow::Content {
  std::unique_ptr<EglContext> egl;
  vtkNew<EglRenderWindow> window;
  std::string errors;
  vtkNew<vtkCallbackCommand> observer;

  void watch(vtkObject* object) {
    if (object->HasObserver(vtkCommand::ErrorEvent, observer)) return;
    object->AddObserver(vtkCommand::ErrorEvent, observer);
    object->AddObserver(vtkCommand::WarningEvent, observer);
  }
};

OffscreenWindow::OffscreenWindow(int width, int height, RenderBackend backend) : content_(std::make_unique<Content>()) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw BadArgument("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels cannot be drawn");
  content_->egl = makeContext(backend);
  content_->observer->SetCallback(noteError);
  content_->observer->SetClientData(&content_->errors);
  EglRenderWindow* w = content_->window;
  w->egl = content_->egl.get();
  content_->watch(w);
  w->SetOwnContext(0);
  w->SetReadyForRendering(true);
  w->OpenGLInitContext();
  w->SetSize(width, height);
  w->SetMultiSamples(0);
  w->SetFrameBlitModeToNoBlit();
  w->SwapBuffersOff();
}

OffscreenWindow::~OffscreenWindow() {
  content_->egl->makeCurrent();
  content_->window->Finalize();
  content_->window->egl = nullptr;
}

vtkRenderWindow* OffscreenWindow::window() {
  return content_->window;
}

void OffscreenWindow::setSize(int width, int height, int samples) {
  content_->egl->makeCurrent();
  content_->window->SetSize(width, height);
  content_->window->SetMultiSamples(samples);
}

Picture OffscreenWindow::capture() {
  content_->egl->makeCurrent();
  EglRenderWindow* w = content_->window;
  vtkRendererCollection* renderers = w->GetRenderers();
  renderers->InitTraversal();
  while (vtkRenderer* renderer = renderers->GetNextItem()) {
    content_->watch(renderer);
    vtkActorCollection* actors = renderer->GetActors();
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor())
      if (actor->GetMapper()) content_->watch(actor->GetMapper());
  }
  content_->watch(w->GetShaderCache());
  content_->errors.clear();
  w->Render();
  const int width = w->GetSize()[0], height = w->GetSize()[1];
  vtkNew<vtkUnsignedCharArray> pixels;
  w->GetPixelData(0, 0, width - 1, height - 1, 0, pixels, 0);
  if (!content_->errors.empty()) throw Error("drawing the 3-D scene failed: " + content_->errors);
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  if (pixels->GetNumberOfValues() != static_cast<vtkIdType>(row) * height)
    throw Error("drawing the 3-D scene gave no pixels");
  Picture picture{width, height, {}};
  picture.rgb.resize(row * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    std::memcpy(picture.rgb.data() + static_cast<std::size_t>(y) * row,
                pixels->GetPointer(static_cast<vtkIdType>(row) * (height - 1 - y)), row);
  return picture;
}

}  // namespace glisson::render
