// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>

#include "pipeline/scene.h"
#include "session/worker.h"
#include "tools/model_picture.h"

namespace glisson::session {

class Session;

/// The model as it would be run now, made by a worker while somebody looks at it: surface, vessels, stiffness, sites,
/// what holds it and where the bar lies. What does not depend on supports and bar is kept.
class ModelPreview : public QObject {
  Q_OBJECT
 public:
  explicit ModelPreview(Session& session);
  ~ModelPreview() override;

  /// Tells that the picture is looked at: it is made anew where something has changed since.
  void want();
  std::shared_ptr<const tools::ModelPicture> picture() const { return picture_; }
  const QString& problem() const { return problem_; }  ///< why there is none
  QString words() const;                               ///< the same, or how far it is
  bool busy() const { return worker_.busy() || delay_.isActive(); }

 signals:
  void changed();
  void progressed();

 private:
  struct Body;
  void start();
  Session& session_;
  Worker worker_;
  QTimer delay_;  ///< gestures follow each other quickly
  std::shared_ptr<const Body> body_;
  std::shared_ptr<const tools::ModelPicture> picture_;
  QString problem_, progress_;
  std::optional<std::uint64_t> made_ = 0;  ///< revision of the session that the picture shows; empty: of none
};

}  // namespace glisson::session
