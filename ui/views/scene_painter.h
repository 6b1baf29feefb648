// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QObject>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "tools/scene_camera.h"

class vtkRenderer;

namespace glisson::views {

/// Draws one 3-D scene on a thread of its own, without a window: the thread owns the OpenGL context and every VTK
/// object of the scene, and hands over finished pictures. Whatever a frame costs, the window's thread goes on.
class ScenePainter : public QObject {
  Q_OBJECT
 public:
  /// On the painter's thread; an exception is told by failed().
  using Change = std::function<void(vtkRenderer& renderer)>;
  /// One picture that is wished for.
  struct Wish {
    std::optional<tools::SceneCamera> camera;  ///< empty: as the scene set it up
    int width = 0, height = 0;                 ///< device pixels
    bool hurried = false;                      ///< something moves: coarser where a frame would take too long
    std::uint64_t number = 0;                  ///< comes back with the picture
  };
  struct Frame {
    QImage image;  ///< of the wish's size where it was not hurried, else perhaps smaller
    tools::SceneCamera camera;
    bool hurried = false;
    double seconds = 0.0;
    std::uint64_t number = 0;  ///< of the wish
  };

  explicit ScenePainter(QObject* parent = nullptr);
  ~ScenePainter() override;  ///< waits for the frame in the making

  /// To be done before the next frame. One that is still waiting under the same key gives way to it.
  void change(int key, Change change);
  /// Ends something that the changes made, on the painter's thread, where its OpenGL parts belong.
  void retire(std::shared_ptr<void> made);
  /// Only the latest wish counts.
  void paint(const Wish& wish);
  /// A wish that still waits is not fulfilled any more.
  void forget();

 signals:
  void painted(const glisson::views::ScenePainter::Frame& frame);
  void failed(const QString& reason);

 private:
  void work(const std::stop_token& stop);
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::map<int, Change> changes_;               // guarded by mutex_
  std::optional<Wish> wish_;                    // guarded by mutex_
  std::vector<Change> replaced_;                // guarded by mutex_; they may hold the last reference to a retired part
  std::vector<std::shared_ptr<void>> retired_;  // guarded by mutex_
  std::jthread thread_;                         // last: it ends before what it uses
};

}  // namespace glisson::views
